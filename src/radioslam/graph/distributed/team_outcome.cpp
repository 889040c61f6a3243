#include "radioslam/graph/distributed/team_outcome.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "radioslam/graph/initial_values.hpp"

namespace radioslam {
namespace {

/// The factors that the team ended up with: between poses of one frame, and with the weights it gave them.
template <class Pose>
PoseGraph<Pose> judged_graph(const PoseGraph<Pose>& graph, const TeamOptimization<Pose>& run) {
  PoseGraph<Pose> judged = graph;
  judged.poses = run.poses;
  judged.relative_poses.clear();
  for (std::size_t k = 0; k < graph.relative_poses.size(); ++k) {
    RelativePoseFactor<Pose> factor = graph.relative_poses[k];
    if (!run.frames[factor.i.index()].same(run.frames[factor.j.index()])) continue;
    if (!run.weights.empty()) factor.weight *= run.weights[k];
    if (factor.weight > 0) judged.relative_poses.push_back(factor);
  }
  return judged;
}

/// The lower of what is reached from a start of its own and from where the team ended.
template <class Pose>
double central_cost(PoseGraph<Pose> graph, const OptimizerParams& params) {
  PoseGraph<Pose> from_team = graph;
  const double there = optimize(from_team, params).final_cost;
  initialise(graph, GivenValues::kNone);
  return std::min(there, optimize(graph, params).final_cost);
}

void add_traffic(Traffic& sum, const Traffic& round) {
  sum.messages += round.messages;
  sum.lost += round.lost;
  sum.header_bytes += round.header_bytes;
  for (std::size_t k = 0; k < kSectionKinds; ++k) sum.section_bytes[k] += round.section_bytes[k];
}

}  // namespace

template <class Pose>
NumberedTeam<Pose> number_robots(const TeamGraph<Pose>& team) {
  NumberedTeam<Pose> numbered;
  std::map<std::string, RobotNumber> numbers;
  std::vector<RobotNumber> robot_of(team.graph.poses.size());
  for (const TrajectorySegment& segment : team.segments) {
    const auto number = numbers.try_emplace(segment.robot, static_cast<RobotNumber>(numbers.size()));
    if (number.second) numbered.names.push_back(segment.robot);
    for (std::size_t k = 0; k < segment.pose_count; ++k)
      robot_of[segment.first_pose + k] = number.first->second;
  }
  numbered.poses = team_poses(robot_of, numbered.names.size());
  numbered.graph = team.graph;
  numbered.graph.pose_priors.clear();
  return numbered;
}

/// Costs below the smallest decrease that any method looks for are those of an exact fit.
double TeamOutcome::gap_of(double at_cost) const {
  constexpr double kExactFit = 1e-6;
  return (at_cost - central_cost) / std::max(central_cost, kExactFit);
}

template <class Pose>
TeamOutcome team_outcome(const NumberedTeam<Pose>& team, const TeamOptimization<Pose>& run,
                         const OptimizerParams& params) {
  const PoseGraph<Pose> judged = judged_graph(team.graph, run);
  TeamOutcome outcome;
  outcome.cost = total_cost(judged);
  outcome.central_cost = central_cost(judged, params);
  const auto look_at = [&](const RoundTrace& round, std::size_t rounds) {
    const double gap = outcome.gap_of(round.cost);
    if (!round.one_frame || std::abs(gap) > kAtOptimum) {
      outcome.rounds_to_optimum.reset();
      outcome.bytes_to_optimum.reset();
    } else if (!outcome.rounds_to_optimum) {
      outcome.rounds_to_optimum = rounds;
      outcome.bytes_to_optimum = outcome.traffic.bytes();
    }
    return round.one_frame ? std::optional(gap) : std::nullopt;
  };
  look_at(run.start, 0);
  for (const RoundTrace& round : run.rounds) {
    add_traffic(outcome.traffic, round.traffic);
    outcome.gaps.push_back(look_at(round, outcome.gaps.size() + 1));
  }
  return outcome;
}

template <class Pose>
std::size_t bytes_of_all_graphs(const NumberedTeam<Pose>& team) {
  constexpr std::size_t kDof = Pose::kDof, kPose = kDof == 3 ? 3 : 7;
  constexpr std::size_t kFactor = 8 * (kPose + kDof * (kDof + 1) / 2) + 8;
  return (team.names.size() - 1) * team.graph.relative_poses.size() * kFactor;
}

template NumberedTeam<SE2> number_robots(const TeamGraph<SE2>&);
template NumberedTeam<SE3> number_robots(const TeamGraph<SE3>&);
template TeamOutcome team_outcome(const NumberedTeam<SE2>&, const TeamOptimization<SE2>&,
                                  const OptimizerParams&);
template TeamOutcome team_outcome(const NumberedTeam<SE3>&, const TeamOptimization<SE3>&,
                                  const OptimizerParams&);
template std::size_t bytes_of_all_graphs(const NumberedTeam<SE2>&);
template std::size_t bytes_of_all_graphs(const NumberedTeam<SE3>&);

}  // namespace radioslam
