#include "radioslam/pipeline/scan_stage.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

/// Motion from one time to the other by recorded odometry, where it covers both.
std::optional<SE3> recorded_motion(const Trajectory<SE3>& odometry, Stamp from, Stamp to) {
  const auto a = odometry.at(from), b = odometry.at(to);
  if (!a || !b) return std::nullopt;
  return a->inverse() * *b;
}

bool uses_inertial(const Robot& robot, const ScanParams& params) {
  return params.inertial.stage.enabled && !robot.inertial.empty();
}

/// One robot's scans in a row.
struct ScanTrack {
  std::vector<ScanPose> poses;  ///< those registered, without their clouds
  std::vector<std::size_t> keyframes;
  std::vector<ScanCloud> clouds;  ///< of the keyframes
  std::map<ScanOutcome, std::size_t> outcomes;
  PointCounts points;
  double usual_share = 0;
  bool is_level = false;  ///< gravity told how the first pose stands
};

/// A first scan that the next ones did not fit is no place to start from.
void forget_start(ScanTrack& track) {
  track.poses.clear();
  track.keyframes.clear();
  track.clouds.clear();
  track.usual_share = 0;
}

/// Keyframes by the rule of select_keyframes, but for the last pose, which is not known to be the last yet.
bool starts_keyframe(const ScanTrack& track, const KeyframeParams& params) {
  if (track.keyframes.empty()) return true;
  return is_new_keyframe(track.poses[track.keyframes.back()].T_start_body, track.poses.back().T_start_body,
                         params);
}

ScanTrack track_scans(const Robot& robot, const ScannerTraits& traits, const ScanParams& params,
                      const KeyframeParams& keyframes, const Progress& progress) {
  ScanOdometer odometer(traits, params.lidar);
  InertialGuide guide(robot.inertial, params.inertial);
  ScanTrack track;
  ScanCloud last_cloud;
  for (std::size_t k = 0; k < robot.lidar.size(); ++k) {
    const Stamp stamp = robot.lidar.stamps[k];
    std::optional<SE3> motion;
    if (uses_inertial(robot, params)) motion = guide.motion_to(stamp);
    if (!motion && !track.poses.empty())
      motion = recorded_motion(robot.odometry, track.poses.back().stamp, stamp);
    ScanPose pose = odometer.add(stamp, robot.lidar.read(k), motion);
    report_progress(progress, "scans of " + robot.id,
                    static_cast<double>(k + 1) / static_cast<double>(robot.lidar.size()));
    ++track.outcomes[pose.outcome];
    track.points += pose.counts;
    if (!is_on_the_way(pose.outcome)) continue;
    if (pose.outcome == ScanOutcome::kNewMap && track.poses.size() == 1) {
      forget_start(track);
      guide = InertialGuide(robot.inertial, params.inertial);
    }
    if (uses_inertial(robot, params)) guide.add(pose);
    last_cloud = std::exchange(pose.cloud, {});
    track.usual_share += pose.matched_share;
    track.poses.push_back(std::move(pose));
    if (!starts_keyframe(track, keyframes)) continue;
    track.keyframes.push_back(track.poses.size() - 1);
    track.clouds.push_back(last_cloud);
  }
  if (!track.poses.empty() && track.keyframes.back() + 1 < track.poses.size()) {
    track.keyframes.push_back(track.poses.size() - 1);
    track.clouds.push_back(std::move(last_cloud));
  }
  track.usual_share /= static_cast<double>(std::max<std::size_t>(1, track.poses.size() - 1));
  return track;
}

/// The recorded rows from `begin` on, up to `end`, moved so that they meet `T_start_body` at `at`.
std::vector<StampedPose<SE3>> led_on(const Trajectory<SE3>& odometry, Stamp begin, Stamp end, Stamp at,
                                     const SE3& T_start_body) {
  std::vector<StampedPose<SE3>> rows;
  const auto meets = odometry.at(at);
  if (!meets) return rows;
  const SE3 T_start_odometry = T_start_body * meets->inverse();
  for (const auto& row : odometry)
    if (begin < row.stamp && row.stamp < end) rows.push_back({row.stamp, T_start_odometry * row.pose});
  return rows;
}

/// Noise of a recorded step by the robot's stated random walk.
OdometryStepNoise stated_noise(const StampedPose<SE3>& a, const StampedPose<SE3>& b,
                               const OdometryNoise& noise) {
  const Trajectory<SE3> rows({a, b});
  return {a.stamp, b.stamp,
          odometry_edge<SE3>(rows, 0, 1, noise).covariance / seconds_between(a.stamp, b.stamp)};
}

/// Where the scans' poses begin in the frame of the recorded odometry: known starts and compasses speak of
/// that.
SE3 start_of_scans(const Trajectory<SE3>& odometry, const ScanTrack& track) {
  for (const ScanPose& pose : track.poses)
    if (const auto recorded = odometry.at(pose.stamp)) {
      const SE3 T = *recorded * pose.T_start_body.inverse();
      return track.is_level ? lift(flatten(T), T.translation().z()) : T;
    }
  return {};
}

/// The robot's odometry by its scans, with recorded rows before and after.
void take_odometry(Robot& robot, ScanTrack& track) {
  const SE3 T_start_scans = start_of_scans(robot.odometry, track);
  for (ScanPose& pose : track.poses) pose.T_start_body = T_start_scans * pose.T_start_body;
  constexpr Stamp kEver{std::numeric_limits<std::int64_t>::max()},
      kNever{std::numeric_limits<std::int64_t>::min()};
  const ScanPose &first = track.poses.front(), &last = track.poses.back();
  OdometryNoise stated = robot.odometry_noise;
  stated.steps.clear();
  auto rows = led_on(robot.odometry, kNever, first.stamp, first.stamp, first.T_start_body);
  const std::size_t before = rows.size();
  for (const ScanPose& pose : track.poses) rows.push_back({pose.stamp, pose.T_start_body});
  const auto after = led_on(robot.odometry, last.stamp, kEver, last.stamp, last.T_start_body);
  rows.insert(rows.end(), after.begin(), after.end());
  std::vector<OdometryStepNoise> steps;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const bool by_scans = k > before && k < before + track.poses.size();
    steps.push_back(by_scans ? OdometryStepNoise{rows[k - 1].stamp, rows[k].stamp,
                                                 track.poses[k - before].covariance /
                                                     seconds_between(rows[k - 1].stamp, rows[k].stamp)}
                             : stated_noise(rows[k - 1], rows[k], stated));
  }
  robot.odometry = Trajectory<SE3>(std::move(rows));
  robot.odometry_noise = {0, 0, 0, 0, 0, 0, std::move(steps)};
}

/// Puts the estimate from scans and readings in the place of that from scans alone.
bool take_readings(ScanTrack& track, const std::vector<InertialSample>& samples,
                   const InertialParams& params) {
  const auto smoothed = smooth_scans(track.poses, samples, params);
  if (!smoothed) return false;
  for (std::size_t k = 0; k < track.poses.size(); ++k) {
    track.poses[k].T_start_body = smoothed->poses[k];
    if (k == 0) continue;
    const Stamp begin = track.poses[k - 1].stamp, end = track.poses[k].stamp;
    track.poses[k].covariance = measured_covariance(smoothed->steps, begin, end);
  }
  return true;
}

/// A robot that nothing tells to move, from its first scan on.
void stand_still(Robot& robot) {
  if (robot.odometry.empty()) robot.odometry = Trajectory<SE3>({{robot.lidar.stamps.front(), SE3()}});
}

ScanKeyframes keyframes_of(ScanTrack& track, const ScannerTraits& traits) {
  ScanKeyframes result;
  result.usual_share = track.usual_share;
  result.spacing_m = traits.spacing_m;
  result.kind = traits.kind;
  for (std::size_t n = 0; n < track.keyframes.size(); ++n) {
    result.poses.push_back(track.poses[track.keyframes[n]].T_start_body);
    if (n == 0) continue;
    UncertainPose<SE3> step;
    for (std::size_t k = track.keyframes[n - 1] + 1; k <= track.keyframes[n]; ++k)
      step =
          step * UncertainPose<SE3>{track.poses[k - 1].T_start_body.inverse() * track.poses[k].T_start_body,
                                    track.poses[k].covariance};
    result.step_covariances.push_back(step.covariance);
  }
  result.clouds = std::move(track.clouds);
  return result;
}

void add_notes(MeasuredScans& measured, const Robot& robot, const ScanTrack& track) {
  const auto note = [&](std::size_t count, const std::string& what) {
    if (count > 0) measured.notes.push_back("robot " + robot.id + ": " + std::to_string(count) + ' ' + what);
  };
  const auto outcome = [&](ScanOutcome o) { return track.outcomes.contains(o) ? track.outcomes.at(o) : 0; };
  measured.too_few += outcome(ScanOutcome::kTooFew);
  measured.unmatched += outcome(ScanOutcome::kUnmatched);
  note(outcome(ScanOutcome::kTooFew), "scans had hardly any points and were left out");
  note(outcome(ScanOutcome::kUnmatched), "scans did not fit the map and were left out");
  note(outcome(ScanOutcome::kNewMap),
       "times scans fitted nothing for long or were missing, and a new map was begun: how the robot moved "
       "there is not known");
  note(track.points.not_finite, "points were no numbers");
  note(track.points.off_time, "points' times were farther from their scan's than scan_points.most_time_s");
  note(track.points.far, "points were farther away than scan_points.most_range_m");
}

}  // namespace

MeasuredScans measure_scans(Mission& mission, const ScanParams& params, const KeyframeParams& keyframes,
                            const Progress& progress) {
  MeasuredScans measured;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    Robot& robot = mission.robots[r];
    if (robot.lidar.empty()) continue;
    if (params.stage.odometry == "recorded" && !robot.odometry.empty()) continue;
    const ScannerTraits traits = scanner_traits(robot.lidar, params.lidar);
    ScanTrack track = track_scans(robot, traits, params, keyframes, progress);
    add_notes(measured, robot, track);
    measured.scans += robot.lidar.size();
    if (track.poses.empty()) {
      stand_still(robot);
      continue;
    }
    measured.registered += track.poses.size();
    if (uses_inertial(robot, params) && !take_readings(track, robot.inertial, params.inertial))
      measured.notes.push_back("robot " + robot.id +
                               ": its inertial readings do not go with its scans and were left out");
    const ScanKeyframes scans = keyframes_of(track, traits);
    take_odometry(robot, track);
    const ScanLoops loops = close_scan_loops(scans, params.loops, params.lidar.map, params.search,
                                             params.lidar.registration, progress);
    for (const ScanLoop& loop : loops.loops)
      measured.closures.push_back({RobotIndex(r), track.poses[track.keyframes[loop.i]].stamp,
                                   track.poses[track.keyframes[loop.j]].stamp, loop});
  }
  return measured;
}

}  // namespace radioslam
