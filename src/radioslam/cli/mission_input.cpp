#include "radioslam/cli/mission_input.hpp"

#include <algorithm>
#include <filesystem>

#include "radioslam/io/mission_folder.hpp"
#include "radioslam/io/team_graph_file.hpp"

namespace radioslam::cli {
namespace {

/// The poses of one robot's pieces, by `poses`.
template <class Pose>
Trajectory<SE3> trajectory(const TeamGraph<Pose>& team, const std::string& robot,
                           const std::vector<Pose>& poses) {
  std::vector<StampedPose<SE3>> rows;
  for (const Piece& piece : team.pieces) {
    if (piece.robot != robot) continue;
    for (std::size_t k = 0; k < piece.pose_count; ++k)
      rows.push_back({piece.stamps[k], as_se3(poses[piece.first_pose + k], 0)});
  }
  return Trajectory<SE3>(std::move(rows));
}

template <class Pose>
MissionInput from_graph(TeamGraphFile<Pose> file, const std::string& path) {
  MissionInput input;
  input.mission.name = std::filesystem::path(path).filename().string();
  input.mission.dimension = Pose::kDim;
  for (const Piece& piece : file.team.pieces) {
    auto& robots = input.mission.robots;
    const bool known =
        std::any_of(robots.begin(), robots.end(), [&](const auto& r) { return r.id == piece.robot; });
    if (known) continue;
    Robot& robot = robots.emplace_back();
    robot.id = piece.robot;
    robot.odometry = trajectory(file.team, piece.robot, file.team.graph.poses);
    RobotTruth& truth = input.truth.robots.emplace_back();
    truth.id = piece.robot;
    if (!file.true_poses.empty()) truth.poses = trajectory(file.team, piece.robot, file.true_poses);
  }
  input.graph = std::move(file.team);
  return input;
}

}  // namespace

MissionInput read_input(const std::string& path) {
  if (is_graph_file(path)) {
    auto graph = read_team_graph(path);
    return std::visit([&](auto& file) { return from_graph(std::move(file), path); }, graph);
  }
  MissionInput input;
  input.mission = read_mission(path);
  input.truth = read_truth(path, input.mission);
  return input;
}

RunOutput run_input(const MissionInput& input, const RunParams& params, const RunOptions& options,
                    const Progress& progress) {
  return std::visit(
      [&](const auto& graph) {
        if constexpr (std::is_same_v<std::decay_t<decltype(graph)>, std::monostate>)
          return run_pipeline(input.mission, params, options, progress);
        else
          return run_pipeline(input.mission, graph, params, options, progress);
      },
      input.graph);
}

}  // namespace radioslam::cli
