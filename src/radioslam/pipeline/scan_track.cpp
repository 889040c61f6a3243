#include "radioslam/pipeline/scan_track.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/pipeline/inertial_guide.hpp"

namespace radioslam {
namespace {

/// Motion from one time to the other by recorded odometry, where it covers both.
std::optional<SE3> recorded_motion(const Trajectory<SE3>& odometry, Stamp from, Stamp to) {
  const auto a = odometry.at(from), b = odometry.at(to);
  if (!a || !b) return std::nullopt;
  return a->inverse() * *b;
}

class ScanTracker {
 public:
  ScanTracker(const Robot& robot, ScanGuide by, const ScannerTraits& traits, const ScanParams& params,
              const KeyframeParams& keyframes)
      : robot_(robot),
        by_(by),
        params_(params),
        keyframes_(keyframes),
        odometer_(traits, params.lidar),
        guide_(robot.inertial, params.inertial) {}

  /// Scan k of the robot, the next one.
  void add(std::size_t k) {
    const Stamp stamp = robot_.lidar.stamps[k];
    LidarScan scan = robot_.lidar.read(k);
    std::optional<ScanGuess> guess = guess_of(stamp, scan);
    const std::optional<SE3> motion = motion_to(stamp, guess);
    if (guess) scan = unbent(std::move(scan), guess->way, params_.lidar.points);
    ScanPose pose = odometer_.add(stamp, scan, motion);
    ++track_.outcomes[pose.outcome];
    track_.points += pose.counts;
    if (!is_on_the_way(pose.outcome)) return;
    if (pose.outcome == ScanOutcome::kNewMap && track_.poses.size() == 1) forget_start();
    if (by_ == ScanGuide::kReadings) guide_.add(pose, guess);
    append(std::move(pose));
  }

  ScanTrack finish() && {
    if (!track_.poses.empty() && track_.keyframes.back() + 1 < track_.poses.size())
      add_keyframe(std::move(last_cloud_));
    track_.usual_share /= static_cast<double>(std::max<std::size_t>(1, track_.poses.size() - 1));
    return std::move(track_);
  }

 private:
  std::optional<ScanGuess> guess_of(Stamp stamp, const LidarScan& scan) const {
    if (by_ == ScanGuide::kNone) return std::nullopt;
    return guide_.guess(stamp, swept_time(scan, params_.lidar.points));
  }

  /// Since the scan before, where anything but scans tells it.
  std::optional<SE3> motion_to(Stamp stamp, const std::optional<ScanGuess>& guess) const {
    if (guess && guess->T_previous_body) return guess->T_previous_body;
    if (track_.poses.empty()) return std::nullopt;
    return recorded_motion(robot_.odometry, track_.poses.back().stamp, stamp);
  }

  void forget_start() {
    track_.poses.clear();
    track_.keyframes.clear();
    track_.clouds.clear();
    track_.usual_share = 0;
    guide_ = InertialGuide(robot_.inertial, params_.inertial);
  }

  void append(ScanPose pose) {
    last_cloud_ = std::exchange(pose.cloud, {});
    track_.usual_share += pose.matched_share;
    track_.poses.push_back(std::move(pose));
    if (starts_keyframe()) add_keyframe(last_cloud_);
  }

  /// But for the last pose, which is not known to be the last yet.
  bool starts_keyframe() const {
    if (track_.keyframes.empty()) return true;
    return is_new_keyframe(track_.poses[track_.keyframes.back()].T_start_body,
                           track_.poses.back().T_start_body, keyframes_);
  }

  void add_keyframe(ScanCloud cloud) {
    track_.keyframes.push_back(track_.poses.size() - 1);
    track_.clouds.push_back(std::move(cloud));
  }

  const Robot& robot_;
  ScanGuide by_;
  const ScanParams& params_;
  const KeyframeParams& keyframes_;
  ScanOdometer odometer_;
  InertialGuide guide_;
  ScanTrack track_;
  ScanCloud last_cloud_;  ///< of the last pose
};

}  // namespace

ScanTrack track_scans(const Robot& robot, std::size_t until, ScanGuide by, const ScannerTraits& traits,
                      const ScanParams& params, const KeyframeParams& keyframes, const Progress& progress) {
  ScanTracker tracker(robot, by, traits, params, keyframes);
  for (std::size_t k = 0; k < until; ++k) {
    tracker.add(k);
    report_progress(progress, "scans of " + robot.id,
                    static_cast<double>(k + 1) / static_cast<double>(until));
  }
  return std::move(tracker).finish();
}

ScanKeyframes take_keyframes(ScanTrack& track, const ScannerTraits& traits) {
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

}  // namespace radioslam
