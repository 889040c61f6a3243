#include "radioslam/cli/commands/evaluation.hpp"

#include <algorithm>
#include <cstdio>

#include "radioslam/base/units.hpp"
#include "radioslam/io/run/run_tables.hpp"
#include "radioslam/results/note_groups.hpp"

namespace radioslam::cli {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

std::string table_row(const std::string& name, const std::optional<ErrorStatistics>& ate, double coverage) {
  if (!ate)
    return formatted("%-24.24s %8s %8s %8s %8s %8.1f %%\n", name.c_str(), "-", "-", "-", "-", 100 * coverage);
  return formatted("%-24.24s %8.3f %8.3f %8.3f %8.3f %8.1f %%\n", name.c_str(), ate->rmse_m, ate->mean_m,
                   ate->median_m, ate->p90_m, 100 * coverage);
}

}  // namespace

std::vector<std::string> frame_notes(const std::vector<EstimatedTrajectory>& robots,
                                     const std::vector<Component>& components,
                                     const std::vector<std::string>& unplaced) {
  std::vector<std::string> notes;
  for (const auto& robot : robots) {
    const bool lost = contains(unplaced, robot.id);
    if (!lost && !is_elsewhere(robot.id, components)) continue;
    notes.push_back("robot " + robot.id + (lost ? " is not placed" : " is in another frame") +
                    ": it counts as not covered");
  }
  return notes;
}

std::vector<EstimatedTrajectory> dead_reckoning(const Mission& mission) {
  std::vector<EstimatedTrajectory> robots;
  for (const auto& robot : mission.robots) {
    if (!robot.initial_pose) return {};
    std::vector<StampedPose<SE3>> poses(robot.odometry.begin(), robot.odometry.end());
    if (robot.odometry.empty()) return {};  // odometry is estimated from LiDAR scans
    const SE3 T_common_start = *robot.initial_pose * robot.odometry.front().pose.inverse();
    for (auto& row : poses) row.pose = T_common_start * row.pose;
    robots.push_back({robot.id, Trajectory<SE3>(std::move(poses))});
  }
  return robots;
}

std::string notes_text(const std::vector<std::string>& notes, const std::vector<std::string>& robots) {
  std::string text;
  for (const NoteGroup& group : grouped_notes(notes, robots)) text += "note: " + line_of(group) + '\n';
  return text;
}

std::string metrics_table(const TeamMetrics& metrics) {
  std::string table = formatted("%-24s %8s %8s %8s %8s %10s\n", "position error, m", "rmse", "mean", "median",
                                "p90", "coverage");
  for (const auto& robot : metrics.robots) table += table_row(robot.id, robot.ate, robot.coverage);
  table += table_row("team", metrics.ate, metrics.coverage);
  if (metrics.rpe) {
    table += formatted("relative error per step: %.4f m, %.3f deg over %zu steps\n",
                       metrics.rpe->translation_rmse_m, kDegreesPerRadian * metrics.rpe->rotation_rmse_rad,
                       metrics.rpe->count);
  }
  if (metrics.rotation_rmse_rad)
    table += formatted("rotation: %.3f deg rmse\n", kDegreesPerRadian * *metrics.rotation_rmse_rad);
  return table;
}

Mission without_recordings(const Mission& mission) {
  Mission reduced;
  reduced.dimension = mission.dimension;
  for (const Robot& robot : mission.robots) {
    Robot& kept = reduced.robots.emplace_back();
    kept.id = robot.id;
    if (!robot.csi) continue;
    kept.csi.emplace();
    kept.csi->antennas_m = robot.csi->antennas_m;
  }
  reduced.anchors = mission.anchors;
  reduced.ranges = mission.ranges;
  reduced.aoa_measurements = mission.aoa_measurements;
  reduced.matches = mission.matches;
  return reduced;
}

ClosuresByKind compare_closures_with_truth(const RunResult& result, const Mission& mission,
                                           const Truth& truth, const FileLoops& file) {
  std::vector<std::vector<Stamp>> keyframes;
  for (const RobotResult& robot : result.robots) keyframes.push_back(robot.estimate.stamps());
  return compare_closures_with_truth(result.closures, keyframes, mission, truth, result.aoa_measurements,
                                     file);
}

std::string closures_by_kind_text(const ClosuresByKind& closures) {
  std::string text;
  for (const auto& [kind, counts] : closures) {
    text += formatted("  %s: %zu accepted, %zu of them true; %zu rejected, %zu of them true\n",
                      std::string(closure_kind_name(kind)).c_str(), counts.accepted, counts.true_accepted,
                      counts.rejected, counts.true_rejected);
    if (counts.worst_accepted_m)
      text += formatted("       largest error of an accepted one: %.3f m, %.3f deg\n",
                        *counts.worst_accepted_m, kDegreesPerRadian * counts.worst_accepted_rad.value_or(0));
    if (kind == ClosureKind::kAoa)
      text += formatted("       accepted path: direct %zu, wrong %zu; no path direct %zu\n",
                        counts.direct_found, counts.wrong_path, counts.none_direct);
  }
  return text;
}

}  // namespace radioslam::cli
