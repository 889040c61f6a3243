#include "radioslam/graph/distributed/team_optimization.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/distributed/alternating.hpp"
#include "radioslam/graph/distributed/block_coordinate.hpp"
#include "radioslam/graph/distributed/separators.hpp"
#include "radioslam/graph/distributed/two_stage.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

template <class Pose>
std::unique_ptr<DistributedSolver<Pose>> make_solver(RobotGraph<Pose> robot,
                                                     const TeamOptimizationParams& params) {
  switch (params.method) {
    case DistributedMethod::kBlockCoordinate:
      return std::make_unique<BlockCoordinateSolver<Pose>>(std::move(robot), BlockCoordinateParams{});
    case DistributedMethod::kAsynchronous: {
      BlockCoordinateParams block;
      block.accelerated = false;
      return std::make_unique<BlockCoordinateSolver<Pose>>(std::move(robot), block);
    }
    case DistributedMethod::kTwoStage:
      return std::make_unique<TwoStageSolver<Pose>>(std::move(robot), TwoStageParams{});
    case DistributedMethod::kAlternating:
      return std::make_unique<AlternatingSolver<Pose>>(std::move(robot), AlternatingParams{});
    default:
      return std::make_unique<SeparatorsSolver<Pose>>(std::move(robot), SeparatorsParams{});
  }
}

/// Each robot on its own: what it knows without hearing anything.
template <class Pose>
void optimize_own(RobotGraph<Pose>& robot) {
  auto own = own_graph(robot);
  optimize(own, OptimizerParams{});
  std::copy(own.poses.begin(), own.poses.end(), robot.graph.poses.begin());
}

/// The run: all robots and the network between them.
template <class Pose>
class Team {
 public:
  Team(const PoseGraph<Pose>& graph, const TeamPoses& poses, const TeamOptimizationParams& params)
      : graph_(graph), poses_(poses), network_(poses.poses.size(), params.network) {
    for (auto& robot : split_by_robot(graph, poses)) {
      optimize_own(robot);
      solvers_.push_back(make_solver(std::move(robot), params));
    }
    result_.frames.resize(graph.poses.size());
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
    trace.cost = cost();
  }

  bool settled() const {
    return std::all_of(solvers_.begin(), solvers_.end(), [](const auto& s) { return s->settled(); });
  }

  TeamOptimization<Pose> finish() {
    result_.poses = graph_.poses;
    result_.settled = settled();
    for (const auto& solver : solvers_) result_.refused += solver->refused();
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

  double cost() const {
    double sum = 0;
    for (const auto& f : graph_.relative_poses)
      if (result_.frames[f.i.index()].same(result_.frames[f.j.index()]))
        sum += f.weight * squared_norm(graph_, f);
    return sum;
  }

  PoseGraph<Pose> graph_;  ///< with the robots' present values
  const TeamPoses& poses_;
  SimulatedNetwork network_;
  std::vector<std::unique_ptr<DistributedSolver<Pose>>> solvers_;
  TeamOptimization<Pose> result_;
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
