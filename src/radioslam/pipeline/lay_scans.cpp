#include "radioslam/pipeline/lay_scans.hpp"

#include <optional>
#include <utility>

#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/pipeline/inertial_odometry.hpp"

namespace radioslam {
namespace {

bool uses_inertial(const Robot& robot, const ScanParams& params) {
  return params.inertial.stage.enabled && !robot.inertial.empty();
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

}  // namespace

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
  auto wrong = disagreement(trajectory_of(alone.poses), robot.inertial, params.inertial.noise,
                            params.inertial.agreement);
  if (!wrong) {
    ScanTrack together = track(all, ScanGuide::kReadings);
    if (together.poses.empty()) return together;
    wrong = take_readings(together, robot.inertial, params.inertial);
    if (!wrong) return together;
  }
  notes.push_back("robot " + robot.id + ": " + *wrong + "; its inertial readings were left out");
  return checked == all ? std::move(alone) : track(all, ScanGuide::kNone);
}

}  // namespace radioslam
