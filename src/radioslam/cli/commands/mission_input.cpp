#include "radioslam/cli/commands/mission_input.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/pose_chart.hpp"
#include "radioslam/io/graph/information.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/run/robot_logs.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/records/mission_of_logs.hpp"

namespace radioslam::cli {
namespace {

/// The poses of all segments of one robot, taken from `pose_at` where it has one.
template <class Pose, class PoseAt>
Trajectory<SE3> trajectory(const TeamGraph<Pose>& team, const std::string& robot, const PoseAt& pose_at) {
  std::vector<StampedPose<SE3>> rows;
  for (const TrajectorySegment& segment : team.segments) {
    if (segment.robot != robot) continue;
    for (std::size_t k = 0; k < segment.pose_count; ++k)
      if (const std::optional<Pose> pose = pose_at(segment.first_pose + k))
        rows.push_back({segment.stamps[k], as_se3(*pose, 0)});
  }
  return Trajectory<SE3>(std::move(rows));
}

/// Covariance of a relative pose's error at the right, with the axes of space. Directions without information
/// have a very large variance.
template <class Pose>
SE3::Jacobian covariance_of(const RelativePoseFactor<Pose>& factor, PoseChart chart) {
  using Matrix = typename Pose::Jacobian;
  const Matrix information = normal_matrix(chart_derivative(chart, Pose()), factor.information);
  const Matrix covariance = inverse(nearest_information<Pose::kDof>(information));
  if constexpr (Pose::kDim == 3) {
    return covariance;
  } else {
    SE3::Jacobian in_space = SE3::Jacobian::Zero();
    const std::array<int, 3> places{0, 1, 5};  // x, y, yaw
    in_space(places, places) = covariance;
    return in_space;
  }
}

/// The relative poses that are not odometry, which come after it.
template <class Pose>
FileLoops loops_of(const TeamGraphFile<Pose>& file, const Mission& mission) {
  std::vector<std::pair<RobotIndex, Stamp>> keyframes;
  std::size_t first_loop = 0;
  for (const TrajectorySegment& segment : file.team.segments) {
    const auto robot = std::find_if(mission.robots.begin(), mission.robots.end(),
                                    [&](const Robot& r) { return r.id == segment.robot; });
    for (const Stamp stamp : segment.stamps)
      keyframes.emplace_back(static_cast<std::size_t>(robot - mission.robots.begin()), stamp);
    first_loop += segment.pose_count - 1;
  }
  const PoseGraph<Pose>& graph = file.team.graph;
  FileLoops loops;
  for (std::size_t f = first_loop; f < graph.relative_poses.size(); ++f) {
    const RelativePoseFactor<Pose>& factor = graph.relative_poses[f];
    const auto [robot_i, stamp_i] = keyframes[factor.i.index()];
    const auto [robot_j, stamp_j] = keyframes[factor.j.index()];
    loops.loops.push_back(
        {robot_i, robot_j, stamp_i, stamp_j, as_se3(factor.T_i_j, 0), covariance_of(factor, graph.chart)});
    if (!file.labels.empty()) loops.labels.push_back(file.labels[f]);
  }
  return loops;
}

template <class Pose>
MissionInput from_graph(TeamGraphFile<Pose> file, const std::vector<std::string>& paths,
                        StatedStarts starts) {
  const auto is_known = [](const TrajectorySegment& segment) { return segment.in_common_frame; };
  if (starts == StatedStarts::kUsed &&
      std::none_of(file.team.segments.begin(), file.team.segments.end(), is_known))
    throw InputError(paths.front(), 0,
                     "states no starts (priors, or in g2o VERTEX lines) for --known-starts");
  MissionInput input;
  input.mission.name = std::filesystem::path(paths.front()).filename().string();
  if (paths.size() > 1) input.mission.name += " and " + std::to_string(paths.size() - 1) + " more";
  input.mission.dimension = Pose::kDim;
  for (const TrajectorySegment& segment : file.team.segments) {
    auto& robots = input.mission.robots;
    const bool known =
        std::any_of(robots.begin(), robots.end(), [&](const auto& r) { return r.id == segment.robot; });
    if (known) continue;
    Robot& robot = robots.emplace_back();
    robot.id = segment.robot;
    const auto reckoned = [&](std::size_t pose) { return std::optional(file.team.graph.poses[pose]); };
    robot.odometry = trajectory(file.team, segment.robot, reckoned);
    if (starts == StatedStarts::kUsed && segment.in_common_frame)
      robot.initial_pose = robot.odometry.front().pose;
    RobotTruth& truth = input.truth.robots.emplace_back();
    truth.id = segment.robot;
    const auto true_pose = [&](std::size_t pose) { return file.true_poses[pose]; };
    if (!file.true_poses.empty()) truth.poses = trajectory(file.team, segment.robot, true_pose);
  }
  input.loops = loops_of(file, input.mission);
  input.pose_ids = std::move(file.pose_ids);
  input.point_ids = std::move(file.point_ids);
  input.notes = std::move(file.notes);
  input.graph = std::move(file.team);
  return input;
}

/// The mission of these logs, and what there is to say of them before `notes`.
MissionInput from_logs(const TeamLog& team, std::vector<std::string> notes, const std::string& source) {
  MissionInput input;
  try {
    LoggedMission logged = mission_of(team);
    input.mission = std::move(logged.mission);
    input.logged = std::move(logged.closures);
    input.notes = std::move(logged.notes);
  } catch (const std::runtime_error& error) {
    throw InputError(source, 0, error.what());
  }
  input.notes.insert(input.notes.end(), notes.begin(), notes.end());
  for (const Robot& robot : input.mission.robots)
    input.mission.name += (input.mission.name.empty() ? "" : " ") + robot.id;
  return input;
}

/// Those that hold on their own, as logs say them.
void say(const std::vector<VerifiedClosure>& verified, ScannedRecords& records) {
  for (const auto& [closure, judgement] : verified)
    if (judgement.status == ClosureStatus::kAccepted)
      records.closures.push_back({closure.robot_i, closure.robot_j, closure.stamp_i, closure.stamp_j,
                                  closure.T_i_j, inverse<SE3::Jacobian>(closure.information),
                                  judgement.statistic, judgement.doubt});
}

}  // namespace

MissionLogs logs_of_recordings(const Mission& recorded, const MeasuredRecordings& recordings,
                               const RunParams& params, const std::vector<VerifiedClosure>& places) {
  ScannedRecords scanned;
  say(closures_of_scans(recordings.scans.closures), scanned);
  say(places, scanned);
  scanned.places = scanned_places(recordings.scans, params.places.descriptors, params.scans.loops.submap_m);
  return logs_of(recordings.mission ? *recordings.mission : recorded, params.keyframe, scanned);
}

MissionInput read_input(const std::vector<std::string>& paths, StatedStarts starts) {
  const std::string& path = paths.front();
  if (std::all_of(paths.begin(), paths.end(), is_log_file) && starts == StatedStarts::kIgnored) {
    LogFiles logs = read_logs(std::vector<std::filesystem::path>(paths.begin(), paths.end()));
    return from_logs(logs.team, std::move(logs.notes), path);
  }
  if (paths.size() > 1 || is_graph_file(path) || is_graph_folder(path)) {
    auto graph = read_team_graph(std::vector<std::filesystem::path>(paths.begin(), paths.end()), starts);
    return std::visit([&](auto& file) { return from_graph(std::move(file), paths, starts); }, graph);
  }
  if (starts == StatedStarts::kUsed)
    throw InputError("--known-starts", 0,
                     "is for factor graphs: a mission states its starts in mission.yaml");
  MissionInput input;
  input.mission = read_mission(path);
  input.truth = read_truth(path, input.mission);
  return input;
}

RunOutput run_input(MissionInput input, const RunParams& params, const RunOptions& options,
                    const Progress& progress, const std::filesystem::path& log_folder,
                    std::vector<std::optional<TrackedScans>> tracked) {
  if (input.logged)
    return run_pipeline(LoggedMission{std::move(input.mission), *std::move(input.logged), {}}, params,
                        options, progress);
  return std::visit(
      [&](const auto& graph) {
        if constexpr (std::is_same_v<std::decay_t<decltype(graph)>, std::monostate>) {
          StageClock timed;
          const auto recordings =
              measure_recordings(input.mission, params, options, timed, progress, std::move(tracked));
          RunOutput run =
              run_pipeline(input.mission, recordings, params, options, std::move(timed), progress);
          if (!log_folder.empty())
            write_logs(log_folder, logs_of_recordings(input.mission, recordings, params, run.places).robots);
          return run;
        } else {
          return run_pipeline(input.mission, graph, params, options, progress);
        }
      },
      input.graph);
}

}  // namespace radioslam::cli
