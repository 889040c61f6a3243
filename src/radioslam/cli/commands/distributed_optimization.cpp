#include "radioslam/cli/commands/distributed_optimization.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <variant>

#include "radioslam/cli/progress_line.hpp"
#include "radioslam/graph/initial_values.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/team_graph_file.hpp"

namespace radioslam::cli {
namespace {

using Json = nlohmann::ordered_json;

/// A gap up to this counts as the optimum in "rounds_to_optimum".
constexpr double kAtOptimum = 1e-3;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A team's robots by number, and its graph without priors: they would only choose the frame.
template <class Pose>
struct NumberedTeam {
  std::vector<std::string> names;
  TeamPoses poses;
  PoseGraph<Pose> graph;
};

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

template <class Pose>
void refuse_unsupported(const PoseGraph<Pose>& graph, const std::string& file) {
  if (!graph.ranges.empty() || !graph.bearings.empty() || !graph.points.empty() || !graph.positions.empty())
    throw InputError(file, 0,
                     "--distributed takes graphs of relative poses: no ranges, positions or landmarks");
}

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

/// Null where there is none: infinite and undefined numbers are no JSON.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::size_t bytes_of_all_graphs(std::size_t robots, std::size_t factors, std::size_t dof) {
  const std::size_t pose = dof == 3 ? 3 : 7;
  return (robots - 1) * factors * (8 * (pose + dof * (dof + 1) / 2) + 8);
}

template <class Pose>
class OutcomeOf {
 public:
  OutcomeOf(const NumberedTeam<Pose>& team, const TeamOptimization<Pose>& run, const OptimizerParams& params)
      : team_(team), run_(run) {
    const PoseGraph<Pose> judged = judged_graph(team.graph, run);
    cost_ = total_cost(judged);
    central_ = central_cost(judged, params);
  }

  double relative_gap() const { return central_ > 0 ? (cost_ - central_) / central_ : cost_ - central_; }

  Json json() const {
    Json out{{"initial_cost", run_.rounds.empty() ? Json(nullptr) : number(run_.rounds.front().cost)},
             {"final_cost", cost_},
             {"iterations", run_.rounds.size()},
             {"termination", run_.settled ? "converged" : "round limit"},
             {"certificate", nullptr},
             {"poses", team_.graph.poses.size()},
             {"factors", team_.graph.relative_poses.size()},
             {"robots", team_.names},
             {"rounds", run_.rounds.size()},
             {"relative_gap", number(relative_gap())},
             {"central_cost", central_},
             {"frames", frames()}};
    add_traffic(out);
    add_rounds(out);
    if (!run_.weights.empty()) out["weights"] = run_.weights;
    return out;
  }

  std::string text() const {
    std::ostringstream out;
    out << run_.rounds.size() << " rounds, cost " << cost_ << ", " << relative_gap()
        << " above the central optimum relatively; " << bytes_per_robot() << " bytes a robot";
    if (!run_.settled) out << "; the robots had not all come to an end";
    if (frames().size() > 1) out << "; " << frames().size() << " frames that nothing ties together";
    return out.str();
  }

 private:
  /// The robots of each frame.
  Json frames() const {
    std::map<std::pair<RobotNumber, std::uint32_t>, std::vector<std::string>> robots;
    for (std::size_t p = 0; p < run_.frames.size(); ++p) {
      auto& list = robots[{run_.frames[p].origin, run_.frames[p].part}];
      const std::string& name = team_.names[team_.poses.robot_of[p]];
      if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    }
    Json out = Json::array();
    for (const auto& [frame, names] : robots) out.push_back(names);
    return out;
  }

  double bytes_per_robot() const {
    std::size_t bytes = 0;
    for (const auto& round : run_.rounds) bytes += round.traffic.bytes();
    return static_cast<double>(bytes) / static_cast<double>(team_.names.size());
  }

  void add_traffic(Json& out) const {
    Traffic sum;
    for (const auto& round : run_.rounds) {
      sum.messages += round.traffic.messages;
      sum.lost += round.traffic.lost;
      sum.header_bytes += round.traffic.header_bytes;
      for (std::size_t k = 0; k < kSectionKinds; ++k) sum.section_bytes[k] += round.traffic.section_bytes[k];
    }
    Json kinds{{"headers", sum.header_bytes}};
    for (std::size_t k = 0; k < kSectionKinds; ++k)
      if (sum.section_bytes[k] > 0)
        kinds[std::string(to_string(static_cast<SectionKind>(k)))] = sum.section_bytes[k];
    out["bytes_per_robot"] = bytes_per_robot();
    out["bytes"] = sum.bytes();
    out["bytes_by_kind"] = kinds;
    out["bytes_of_all_graphs"] =
        bytes_of_all_graphs(team_.names.size(), team_.graph.relative_poses.size(), Pose::kDof);
    out["messages"] = sum.messages;
    out["messages_lost"] = sum.lost;
    out["messages_refused"] = run_.refused;
  }

  /// Cost and bytes after every round. Costs before the robots are in one frame lack the factors between
  /// frames; the optimum counts as reached from where the cost stays near it.
  void add_rounds(Json& out) const {
    Json rounds = Json::array();
    std::size_t bytes = 0;
    std::optional<std::size_t> reached, reached_bytes;
    for (std::size_t k = 0; k < run_.rounds.size(); ++k) {
      const RoundTrace& round = run_.rounds[k];
      bytes += round.traffic.bytes();
      const double gap = (round.cost - central_) / std::max(central_, 1e-300);
      const bool near = round.one_frame && std::abs(gap) <= kAtOptimum;
      if (near && !reached) reached = k + 1, reached_bytes = bytes;
      if (!near) reached.reset(), reached_bytes.reset();
      rounds.push_back({{"cost", number(round.cost)},
                        {"relative_gap", round.one_frame ? number(gap) : Json(nullptr)},
                        {"bytes", round.traffic.bytes()},
                        {"messages", round.traffic.messages}});
    }
    out["rounds_to_optimum"] = reached ? Json(*reached) : Json(nullptr);
    out["bytes_to_optimum"] = reached_bytes ? Json(*reached_bytes) : Json(nullptr);
    out["per_round"] = std::move(rounds);
  }

  const NumberedTeam<Pose>& team_;
  const TeamOptimization<Pose>& run_;
  double cost_ = 0, central_ = 0;
};

template <class Pose>
DistributedOutcome run_team(TeamGraphFile<Pose>& file, const OptimizeParams& params, double read_s) {
  NumberedTeam<Pose> team = number_robots(file.team);
  if (params.distributed.outliers.gate > 0) discount_repeated(team.graph);
  const auto start = std::chrono::steady_clock::now();
  ProgressLine line;
  const TeamOptimization<Pose> run =
      optimize_team(team.graph, team.poses, params.distributed, line.progress());
  const double optimize_s = seconds_since(start);
  const OutcomeOf<Pose> outcome(team, run, params.optimizer);
  DistributedOutcome result{outcome.json(), outcome.text(), {}};
  result.json["seconds"] = {{"read", read_s}, {"initialise", 0.0}, {"optimise", optimize_s}};
  PoseGraph<Pose> graph = team.graph;
  graph.poses = run.poses;
  result.graph = format_g2o(with_ids(std::move(graph), file.pose_ids, file.point_ids));
  return result;
}

}  // namespace

DistributedOutcome optimize_distributed(const std::vector<std::filesystem::path>& paths,
                                        const std::string& method, const OptimizeParams& params) {
  const auto start = std::chrono::steady_clock::now();
  AnyTeamGraphFile any = read_team_graph(paths, StatedStarts::kIgnored);
  const double read_s = seconds_since(start);
  OptimizeParams used = params;
  for (const auto& [name, value] : kDistributedMethods)
    if (name == method) used.distributed.method = value;
  return std::visit(
      [&](auto& file) {
        refuse_unsupported(file.team.graph, paths.front().string());
        DistributedOutcome outcome = run_team(file, used, read_s);
        outcome.json["method"] = method;
        outcome.json["notes"] = file.notes;
        return outcome;
      },
      any);
}

}  // namespace radioslam::cli
