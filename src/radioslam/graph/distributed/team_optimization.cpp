#include "radioslam/graph/distributed/team_optimization.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/distributed/alternating.hpp"
#include "radioslam/graph/distributed/block_coordinate.hpp"
#include "radioslam/graph/distributed/separators.hpp"
#include "radioslam/graph/distributed/two_stage.hpp"
#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/initial_values.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

/// Rounds without an answer, in networks that lose and delay messages.
constexpr std::uint32_t kRepeatAfter = 4;
/// Rounds without a word, beyond the delay, in which a neighbour's values do not count as old there.
constexpr std::uint32_t kMaxAge = 20;

template <class Pose>
std::unique_ptr<DistributedSolver<Pose>> make_solver(RobotGraph<Pose> robot,
                                                     const TeamOptimizationParams& params) {
  switch (params.method) {
    case DistributedMethod::kBlockCoordinate: {
      BlockCoordinateParams block;
      block.frames = params.frames;
      if (params.network.loss_share > 0 || params.network.delay_rounds > 0)
        block.max_age = static_cast<std::uint32_t>(params.network.delay_rounds) + kMaxAge;
      return std::make_unique<BlockCoordinateSolver<Pose>>(std::move(robot), block);
    }
    case DistributedMethod::kTwoStage: {
      TwoStageParams stages;
      stages.frames = params.frames;
      return std::make_unique<TwoStageSolver<Pose>>(std::move(robot), stages);
    }
    case DistributedMethod::kAlternating: {
      AlternatingParams alternating;
      alternating.frames = params.frames;
      return std::make_unique<AlternatingSolver<Pose>>(std::move(robot), alternating);
    }
    case DistributedMethod::kAsynchronous:
    case DistributedMethod::kSeparators:
      break;
  }
  SeparatorsParams separators;
  separators.frames = params.frames;
  separators.outliers = params.outliers;
  if (params.method == DistributedMethod::kAsynchronous) separators.repeat_after = kRepeatAfter;
  return std::make_unique<SeparatorsSolver<Pose>>(std::move(robot), separators);
}

/// Whether some part of the robot's trajectory shares factors with nobody.
template <class Pose>
bool has_lone_part(const RobotGraph<Pose>& robot) {
  std::vector<bool> lone(robot.parts, true);
  for (const NeighbourRobot& neighbour : robot.neighbours)
    for (const std::uint32_t pose : neighbour.seen) lone[robot.part_of[pose]] = false;
  return std::find(lone.begin(), lone.end(), true) != lone.end();
}

/// Each robot on its own: what it knows without hearing anything. Nobody helps a lone part out of a bad
/// start, so it takes the best one there is. Whether an optimum was reached.
template <class Pose>
bool optimize_own(RobotGraph<Pose>& robot, const OutlierParams& outliers) {
  auto own = own_graph(robot);
  if (has_lone_part(robot)) initialise(own, GivenValues::kComplete);
  FactorMask mask;
  mask.relative_poses = outlier_candidates(robot);
  mask.relative_poses.resize(robot.own_relative_poses);
  const bool loops =
      std::find(mask.relative_poses.begin(), mask.relative_poses.end(), true) != mask.relative_poses.end();
  OptimizerSummary summary;
  if (outliers.gate > 0 && loops) {
    for (auto& factor : own.relative_poses) factor.loss.scale = std::sqrt(outliers.gate);
    summary = optimize_graduated(own, mask, GraduatedLoss::kTruncatedLeastSquares, {}, {}).last;
  } else {
    summary = optimize(own, OptimizerParams{});
  }
  std::copy(own.poses.begin(), own.poses.end(), robot.graph.poses.begin());
  return summary.termination == Termination::kConverged || summary.termination == Termination::kNothingToDo;
}

/// The run: all robots and the network between them.
template <class Pose>
class Team {
 public:
  Team(const PoseGraph<Pose>& graph, const TeamPoses& poses, const TeamOptimizationParams& params)
      : graph_(graph), poses_(poses), network_(poses.poses.size(), params.network) {
    for (auto& robot : split_by_robot(graph, poses)) {
      const bool at_optimum = optimize_own(robot, params.outliers);
      lone_at_optimum_ = lone_at_optimum_ && (at_optimum || !has_lone_part(robot));
      solvers_.push_back(make_solver(std::move(robot), params));
    }
    result_.frames.resize(graph.poses.size());
    collect();
    measure(result_.start);
  }

  void play_round() {
    auto& trace = result_.rounds.emplace_back();
    for (std::size_t r = 0; r < solvers_.size(); ++r) {
      std::vector<Message<Pose>> heard;
      for (const std::string& bytes : network_.receive(static_cast<RobotNumber>(r)))
        if (auto message = decode<Pose>(bytes); message && message->to == r)
          heard.push_back(std::move(*message));
        else
          ++result_.refused;
      for (const auto& message : solvers_[r]->round(heard)) network_.send(message, trace.traffic);
    }
    network_.advance();
    collect();
    measure(trace);
  }

  bool settled() const {
    return std::all_of(solvers_.begin(), solvers_.end(),
                       [](const auto& s) { return s->settled() && s->hears_neighbours(); });
  }

  TeamOptimization<Pose> finish() {
    result_.poses = graph_.poses;
    result_.settled = settled() && lone_at_optimum_;
    for (const auto& solver : solvers_) result_.refused += solver->refused();
    collect_weights();
    return std::move(result_);
  }

 private:
  void collect() {
    for (std::size_t r = 0; r < solvers_.size(); ++r) {
      const auto poses = solvers_[r]->poses();
      const auto frames = solvers_[r]->frames();
      for (std::size_t k = 0; k < poses.size(); ++k) {
        graph_.poses[poses_.poses[r][k]] = poses[k];
        result_.frames[poses_.poses[r][k]] = frames[k];
      }
    }
  }

  /// A robot's factors are in the order of the team's: those within it, then those with others.
  void collect_weights() {
    std::vector<std::vector<std::optional<double>>> weights;
    for (const auto& solver : solvers_) weights.push_back(solver->weights());
    if (std::all_of(weights.begin(), weights.end(), [](const auto& w) { return w.empty(); })) return;
    std::vector<std::size_t> within(solvers_.size(), 0), between(solvers_.size(), 0);
    const auto robot = [&](PoseId pose) { return poses_.robot_of[pose.index()]; };
    for (const auto& f : graph_.relative_poses)
      if (robot(f.i) == robot(f.j)) ++between[robot(f.i)];
    for (const auto& f : graph_.relative_poses) {
      double weight = 1;
      const auto take = [&](RobotNumber r, std::vector<std::size_t>& next) {
        if (const auto judged = weights[r][next[r]++]) weight = *judged;
      };
      if (robot(f.i) == robot(f.j)) {
        take(robot(f.i), within);
      } else {
        take(robot(f.i), between);
        take(robot(f.j), between);
      }
      result_.weights.push_back(weight);
    }
  }

  void measure(RoundTrace& trace) const {
    trace.one_frame = true;
    for (const auto& f : graph_.relative_poses)
      if (result_.frames[f.i.index()].same(result_.frames[f.j.index()]))
        trace.cost += f.weight * squared_norm(graph_, f);
      else
        trace.one_frame = false;
  }

  PoseGraph<Pose> graph_;  ///< with the robots' present values
  const TeamPoses& poses_;
  SimulatedNetwork network_;
  std::vector<std::unique_ptr<DistributedSolver<Pose>>> solvers_;
  TeamOptimization<Pose> result_;
  bool lone_at_optimum_ = true;  ///< robots with parts that share factors with nobody
};

}  // namespace

template <class Pose>
TeamOptimization<Pose> optimize_team(const PoseGraph<Pose>& graph, const TeamPoses& team,
                                     const TeamOptimizationParams& params, const Progress& progress) {
  Team<Pose> robots(graph, team, params);
  for (int round = 0; round < params.max_rounds && !robots.settled(); ++round) {
    report_progress(progress, "optimize", round / double(params.max_rounds));
    robots.play_round();
  }
  return robots.finish();
}

template TeamOptimization<SE2> optimize_team(const PoseGraph<SE2>&, const TeamPoses&,
                                             const TeamOptimizationParams&, const Progress&);
template TeamOptimization<SE3> optimize_team(const PoseGraph<SE3>&, const TeamPoses&,
                                             const TeamOptimizationParams&, const Progress&);

}  // namespace radioslam
