#include "radioslam/pipeline/scan_stage.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "radioslam/base/median.hpp"
#include "radioslam/mission/continuous_trajectory.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/pipeline/inertial_guide.hpp"
#include "radioslam/pipeline/inertial_odometry.hpp"

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

/// Which readings help to lay scans.
enum class ScanGuide { kNone, kReadings };

/// The scans of the first `until` of them.
ScanTrack track_scans(const Robot& robot, std::size_t until, ScanGuide by, const ScannerTraits& traits,
                      const ScanParams& params, const KeyframeParams& keyframes, const Progress& progress) {
  ScanOdometer odometer(traits, params.lidar);
  InertialGuide guide(robot.inertial, params.inertial);
  ScanTrack track;
  ScanCloud last_cloud;
  for (std::size_t k = 0; k < until; ++k) {
    const Stamp stamp = robot.lidar.stamps[k];
    LidarScan scan = robot.lidar.read(k);
    std::optional<ScanGuess> guess;
    if (by == ScanGuide::kReadings) guess = guide.guess(stamp, swept_time(scan, params.lidar.points));
    std::optional<SE3> motion = guess ? guess->T_previous_body : std::nullopt;
    if (!motion && !track.poses.empty())
      motion = recorded_motion(robot.odometry, track.poses.back().stamp, stamp);
    const bool is_unbent = guess && params.inertial.stage.sweep == "readings";
    if (is_unbent) scan = unbent(std::move(scan), guess->way, params.lidar.points);
    ScanPose pose = odometer.add(stamp, scan, motion);
    report_progress(progress, "scans of " + robot.id,
                    static_cast<double>(k + 1) / static_cast<double>(until));
    ++track.outcomes[pose.outcome];
    track.points += pose.counts;
    if (!is_on_the_way(pose.outcome)) continue;
    if (pose.outcome == ScanOutcome::kNewMap && track.poses.size() == 1) {
      forget_start(track);
      guide = InertialGuide(robot.inertial, params.inertial);
    }
    if (by == ScanGuide::kReadings) guide.add(pose, is_unbent ? guess : std::nullopt);
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

/// Recorded rows between two scans, bent to meet both as their noise grew.
std::vector<StampedPose<SE3>> bridged(const Robot& robot, const ScanPose& a, const ScanPose& b) {
  if (!robot.odometry.covers(a.stamp) || !robot.odometry.covers(b.stamp)) return {};
  std::vector<Stamp> stamps;
  for (const auto& row : robot.odometry)
    if (a.stamp < row.stamp && row.stamp < b.stamp) stamps.push_back(row.stamp);
  const Trajectory<SE3> ends({{a.stamp, a.T_start_body}, {b.stamp, b.T_start_body}});
  const ContinuousTrajectory<SE3> way(robot, {ends, {}});
  const auto poses = way.at(stamps);
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t k = 0; k < stamps.size(); ++k) rows.push_back({stamps[k], poses[k].pose});
  return rows;
}

/// Beyond which recorded rows between two scans tell more than the way straight from one to the other.
double longest_scan_step_s(const ScanTrack& track, const ScanStageParams& params) {
  std::vector<double> steps_s;
  for (std::size_t k = 1; k < track.poses.size(); ++k)
    steps_s.push_back(seconds_between(track.poses[k - 1].stamp, track.poses[k].stamp));
  return steps_s.empty() ? 0 : params.gap_steps * upper_median(std::move(steps_s));
}

/// Rows of an odometry, each with the noise of the step to it.
struct NoisyRows {
  std::vector<StampedPose<SE3>> rows;
  std::vector<OdometryStepNoise> steps;

  /// Rows with the robot's stated noise.
  void lead_on(const std::vector<StampedPose<SE3>>& more, const OdometryNoise& stated) {
    for (const auto& row : more) {
      if (!rows.empty()) steps.push_back(stated_noise(rows.back(), row, stated));
      rows.push_back(row);
    }
  }

  /// A scan with the rows that lead to it from the one before; its covariance is spread evenly in time.
  void add_scan(std::vector<StampedPose<SE3>> bridge, const ScanPose& scan) {
    bridge.push_back({scan.stamp, scan.T_start_body});
    const double since_s = seconds_between(rows.back().stamp, scan.stamp);
    for (const auto& row : bridge) {
      steps.push_back({rows.back().stamp, row.stamp, scan.covariance / since_s});
      rows.push_back(row);
    }
  }
};

/// The robot's odometry by its scans, with recorded rows before, after and in their gaps.
void take_odometry(Robot& robot, ScanTrack& track, const ScanStageParams& params) {
  const SE3 T_start_scans = start_of_scans(robot.odometry, track);
  for (ScanPose& pose : track.poses) pose.T_start_body = T_start_scans * pose.T_start_body;
  constexpr Stamp kEver{std::numeric_limits<std::int64_t>::max()},
      kNever{std::numeric_limits<std::int64_t>::min()};
  const ScanPose &first = track.poses.front(), &last = track.poses.back();
  const double longest_s = longest_scan_step_s(track, params);
  OdometryNoise stated = robot.odometry_noise;
  stated.steps.clear();
  NoisyRows by;
  by.lead_on(led_on(robot.odometry, kNever, first.stamp, first.stamp, first.T_start_body), stated);
  by.lead_on({{first.stamp, first.T_start_body}}, stated);
  for (std::size_t k = 1; k < track.poses.size(); ++k) {
    const ScanPose &before = track.poses[k - 1], &scan = track.poses[k];
    const bool is_gap = seconds_between(before.stamp, scan.stamp) > longest_s;
    by.add_scan(is_gap ? bridged(robot, before, scan) : std::vector<StampedPose<SE3>>{}, scan);
  }
  by.lead_on(led_on(robot.odometry, last.stamp, kEver, last.stamp, last.T_start_body), stated);
  robot.odometry = Trajectory<SE3>(std::move(by.rows));
  robot.odometry_noise = {0, 0, 0, 0, 0, 0, std::move(by.steps)};
}

/// Recorded rows before the first scan or after the last that nothing ties to it.
void note_lost_odometry(const Robot& robot, const ScanTrack& track, std::vector<std::string>& notes) {
  const Stamp first = track.poses.front().stamp, last = track.poses.back().stamp;
  std::size_t lost = 0;
  for (const auto& row : robot.odometry)
    if ((row.stamp < first && !robot.odometry.covers(first)) ||
        (last < row.stamp && !robot.odometry.covers(last)))
      ++lost;
  if (lost > 0)
    notes.push_back("robot " + robot.id + ": " + std::to_string(lost) +
                    " rows of recorded odometry do not reach its scans and were left out");
}

void leave_out_wild_readings(Robot& robot, const WildReadingParams& params, std::vector<std::string>& notes) {
  TameReadings tame = leave_out_wild(robot.inertial, params);
  if (tame.left_out == 0) return;
  robot.inertial = std::move(tame.samples);
  notes.push_back("robot " + robot.id + ": " + std::to_string(tame.left_out) +
                  " inertial readings stand out from those about them and were left out");
}

/// Puts the estimate from scans and readings in the place of that from scans alone; says why not.
std::optional<std::string> take_readings(ScanTrack& track, const std::vector<InertialSample>& samples,
                                         const InertialParams& params) {
  const auto smoothed = smooth_scans(track.poses, samples, params);
  if (!smoothed) return "gravity does not show in its readings along its scans";
  if (smoothed->cost_per_step > params.stage.most_cost_per_step) return "its readings contradict its scans";
  for (std::size_t k = 0; k < track.poses.size(); ++k) {
    track.poses[k].T_start_body = smoothed->poses[k];
    if (k == 0) continue;
    const Stamp begin = track.poses[k - 1].stamp, end = track.poses[k].stamp;
    track.poses[k].covariance = measured_covariance(smoothed->steps, begin, end);
  }
  track.is_level = true;
  return std::nullopt;
}

/// How many scans lie within the first seconds.
std::size_t scans_within(const LidarLog& log, double duration_s) {
  std::size_t count = 0;
  while (count < log.size() && seconds_between(log.stamps.front(), log.stamps[count]) <= duration_s) ++count;
  return count;
}

std::optional<std::string> disagreement_with(const ScanTrack& track, const Robot& robot,
                                             const InertialParams& params) {
  std::vector<StampedPose<SE3>> poses;
  for (const ScanPose& scan : track.poses) poses.push_back({scan.stamp, scan.T_start_body});
  return disagreement(Trajectory<SE3>(poses), robot.inertial, params.noise, params.agreement);
}

/// The robot's scans, with its readings where these agree with scans laid by themselves.
ScanTrack lay_scans(Robot& robot, const ScannerTraits& traits, const ScanParams& params,
                    const KeyframeParams& keyframes, const Progress& progress,
                    std::vector<std::string>& notes) {
  const auto track = [&](std::size_t until, ScanGuide by) {
    return track_scans(robot, until, by, traits, params, keyframes, progress);
  };
  const std::size_t all = robot.lidar.size();
  if (!uses_inertial(robot, params)) return track(all, ScanGuide::kNone);
  leave_out_wild_readings(robot, params.inertial.wild, notes);
  const std::size_t checked = scans_within(robot.lidar, params.inertial.stage.check_s);
  ScanTrack alone = track(checked, ScanGuide::kNone);
  auto wrong = disagreement_with(alone, robot, params.inertial);
  if (!wrong) {
    ScanTrack together = track(all, ScanGuide::kReadings);
    if (together.poses.empty()) return together;
    wrong = take_readings(together, robot.inertial, params.inertial);
    if (!wrong) return together;
  }
  notes.push_back("robot " + robot.id + ": " + *wrong + "; its inertial readings were left out");
  return checked == all ? std::move(alone) : track(all, ScanGuide::kNone);
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
    ScanTrack track = lay_scans(robot, traits, params, keyframes, progress, measured.notes);
    add_notes(measured, robot, track);
    measured.scans += robot.lidar.size();
    if (track.poses.empty()) {
      stand_still(robot);
      continue;
    }
    measured.registered += track.poses.size();
    const ScanKeyframes scans = keyframes_of(track, traits);
    note_lost_odometry(robot, track, measured.notes);
    take_odometry(robot, track, params.stage);
    const ScanLoops loops = close_scan_loops(scans, params.loops, params.lidar.map, params.search,
                                             params.lidar.registration, progress);
    for (const ScanLoop& loop : loops.loops)
      measured.closures.push_back({RobotIndex(r), track.poses[track.keyframes[loop.i]].stamp,
                                   track.poses[track.keyframes[loop.j]].stamp, loop});
  }
  return measured;
}

}  // namespace radioslam
