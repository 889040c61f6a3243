#include "radioslam/odometry/scan_tracking_with_imu.hpp"

#include <optional>
#include <utility>

#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/odometry/inertial_odometry.hpp"

namespace radioslam {
namespace {

bool uses_inertial(const Robot& robot, const ScanParams& params) {
  return params.inertial.stage.enabled && !robot.inertial.empty();
}

void remove_outliers(Robot& robot, const ImuOutlierParams& params, std::vector<std::string>& notes) {
  FilteredImu filtered = remove_imu_outliers(robot.inertial, params);
  if (filtered.removed == 0) return;
  robot.inertial = std::move(filtered.samples);
  notes.push_back("robot " + robot.id + ": " + std::to_string(filtered.removed) +
                  " IMU samples are outliers and were removed");
}

/// Replaces the estimate from scans alone by that from scans and IMU; returns why if it cannot.
std::optional<std::string> smooth_with_imu(ScanTrajectory& track, const std::vector<ImuSample>& samples,
                                           const InertialParams& params) {
  const auto smoothed = smooth_scans(track.poses, samples, params);
  if (!smoothed) return "gravity could not be estimated from its IMU data and scans";
  if (smoothed->cost_per_step > params.stage.max_cost_per_step) return "its IMU data contradicts its scans";
  for (std::size_t k = 0; k < track.poses.size(); ++k) {
    track.poses[k].T_start_body = smoothed->poses[k];
    if (k == 0) continue;
    const Stamp begin = track.poses[k - 1].stamp, end = track.poses[k].stamp;
    track.poses[k].covariance = measured_covariance(smoothed->steps, begin, end);
  }
  track.is_level = true;
  return std::nullopt;
}

/// Number of scans within the first `duration_s`.
std::size_t scans_within(const LidarLog& log, double duration_s) {
  std::size_t count = 0;
  while (count < log.size() && seconds_between(log.stamps.front(), log.stamps[count]) <= duration_s) ++count;
  return count;
}

}  // namespace

ScanTrajectory track_scans_with_imu(Robot& robot, const ScannerTraits& traits, const ScanParams& params,
                                    const KeyframeParams& keyframes, const Progress& progress,
                                    std::vector<std::string>& notes) {
  const auto track = [&](std::size_t until, ImuUse by) {
    return track_scans(robot, until, by, traits, params, keyframes, progress);
  };
  const std::size_t all = robot.lidar.size();
  if (!uses_inertial(robot, params)) return track(all, ImuUse::kNone);
  remove_outliers(robot, params.inertial.outliers, notes);
  const std::size_t checked = scans_within(robot.lidar, params.inertial.stage.check_s);
  ScanTrajectory alone = track(checked, ImuUse::kNone);
  auto wrong = find_inconsistency(trajectory_of(alone.poses), robot.inertial, params.inertial.noise,
                                  params.inertial.consistency);
  if (!wrong) {
    ScanTrajectory together = track(all, ImuUse::kReadings);
    if (together.poses.empty()) return together;
    wrong = smooth_with_imu(together, robot.inertial, params.inertial);
    if (!wrong) return together;
  }
  notes.push_back("robot " + robot.id + ": " + *wrong + "; its IMU data was ignored");
  return checked == all ? std::move(alone) : track(all, ImuUse::kNone);
}

}  // namespace radioslam
