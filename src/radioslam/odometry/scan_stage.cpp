#include "radioslam/odometry/scan_stage.hpp"

#include "radioslam/odometry/odometry_from_scans.hpp"
#include "radioslam/odometry/scan_tracking.hpp"
#include "radioslam/odometry/scan_tracking_with_imu.hpp"

namespace radioslam {
namespace {

/// A robot without odometry and registered scans stays at the origin from its first scan on.
ScanOdometry static_odometry(const Robot& robot) {
  return {{Trajectory<SE3>({{robot.lidar.stamps.front(), SE3()}}), robot.odometry_noise}, {}, {}};
}

/// Counts the robot's scans and notes problems.
void report_scans(MeasuredScans& measured, const Robot& robot, const ScanTrajectory& track) {
  const auto note = [&](std::size_t count, const std::string& what) {
    if (count > 0) measured.notes.push_back("robot " + robot.id + ": " + std::to_string(count) + ' ' + what);
  };
  const auto status = [&](ScanStatus o) {
    return track.status_counts.contains(o) ? track.status_counts.at(o) : 0;
  };
  measured.scans += robot.lidar.size();
  measured.registered += track.poses.size();
  measured.too_few += status(ScanStatus::kTooFewPoints);
  measured.lost += status(ScanStatus::kLost);
  note(status(ScanStatus::kTooFewPoints), "scans had too few points and were skipped");
  note(status(ScanStatus::kLost), "scans did not match the map and were skipped");
  note(status(ScanStatus::kNewMap),
       "tracking losses (scans missing or not matching for long): a new map was started each time, and the "
       "motion in between is unknown");
  note(track.points.not_finite, "points or their times were not finite and were ignored");
  note(track.points.off_time,
       "points were more than scan_points.max_time_s from their scan's stamp and were ignored");
  note(track.points.far, "points were beyond scan_points.max_range_m and were ignored");
  note(unreachable_samples(robot.odometry, track),
       "rows of recorded odometry could not be connected to its scans and were dropped");
}

void close_loops(MeasuredScans& measured, RobotIndex robot, const ScanOdometry& scans,
                 const ScanParams& params, const Progress& progress) {
  const ScanLoops loops = close_scan_loops(scans.keyframes, params.loops, params.lidar.map, params.search,
                                           params.lidar.registration, progress);
  for (const ScanLoop& loop : loops.loops)
    measured.closures.push_back({robot, scans.keyframe_stamps[loop.i], scans.keyframe_stamps[loop.j], loop});
}

/// Whether the robot's odometry is that of its scans.
bool is_tracked(const Robot& robot, const ScanParams& params) {
  const bool is_recorded =
      odometry_source(params.stage) == OdometrySource::kRecorded && !robot.odometry.empty();
  return !robot.lidar.empty() && !is_recorded;
}

}  // namespace

MeasuredScans measure_scans(const Mission& mission, const ScanParams& params, const KeyframeParams& keyframes,
                            const Progress& progress) {
  MeasuredScans measured;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    std::optional<ScanOdometry>& scans = measured.robots.emplace_back();
    if (!is_tracked(mission.robots[r], params)) continue;
    Robot robot = mission.robots[r];
    const ScannerTraits traits = scanner_traits(robot.lidar, params.lidar);
    ScanTrajectory track = track_scans_with_imu(robot, traits, params, keyframes, progress, measured.notes);
    report_scans(measured, robot, track);
    if (track.poses.empty()) {
      if (robot.odometry.empty()) scans = static_odometry(robot);
      continue;
    }
    scans.emplace();
    scans->keyframes = extract_keyframes(track, traits);
    scans->odometry = odometry_from_scans(robot, track, params.stage);
    for (const std::size_t k : track.keyframes) scans->keyframe_stamps.push_back(track.poses[k].stamp);
    close_loops(measured, RobotIndex(r), *scans, params, progress);
  }
  return measured;
}

Mission with_odometry(Mission mission, const MeasuredScans& measured) {
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    if (!measured.robots[r]) continue;
    mission.robots[r].odometry = measured.robots[r]->odometry.samples;
    mission.robots[r].odometry_noise = measured.robots[r]->odometry.noise;
  }
  return mission;
}

}  // namespace radioslam
