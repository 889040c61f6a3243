#include "radioslam/odometry/scan_tracking.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/base/stamp_intervals.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/odometry/imu_motion_prior.hpp"
#include "radioslam/odometry/motion_distortion.hpp"

namespace radioslam {
namespace {

class ScanTracker {
 public:
  ScanTracker(const Robot& robot, ImuUse by, const ScannerTraits& traits, const ScanParams& params,
              const KeyframeParams& keyframes)
      : robot_(robot),
        by_(by),
        params_(params),
        keyframes_(keyframes),
        odometry_(traits, params.lidar),
        imu_prior_(robot.inertial, params.inertial),
        sample_interval_s_(median_interval_s(robot.odometry, &StampedPose<SE3>::stamp)),
        scan_interval_s_(median_interval_s(robot.lidar.stamps)),
        distortion_(params.stage.acceleration_smoothing, scan_interval_s_) {}

  /// Registers scan k of the robot, the next one.
  void add(std::size_t k) {
    const Stamp stamp = robot_.lidar.stamps[k];
    LidarScan scan = robot_.lidar.read(k);
    const ScanTimeSpan time = time_span(scan, params_.lidar.points);
    const std::optional<MotionPrior> prior = select_prior(stamp, time);
    const std::optional<SE3> motion = motion_to(stamp, prior);
    if (prior) scan = deskew(std::move(scan), prior->scan_motion, params_.lidar.points);
    ScanPose pose =
        odometry_.register_scan(stamp, scan, motion, prior ? prior->source : MotionSource::kOdometry);
    ++track_.status_counts[pose.status];
    track_.points += pose.counts;
    if (!is_tracked(pose.status)) return;
    if (pose.status == ScanStatus::kNewMap) {
      distortion_.start_new_map();
      previous_distortion_.setZero();
      if (track_.poses.size() == 1) forget_start();
    }
    if (by_ == ImuUse::kReadings) imu_prior_.add(pose, prior);
    add_distortion_covariance(pose, prior ? prior->source : MotionSource::kConstantVelocity, time);
    take_first_cloud(std::exchange(pose.first_cloud, std::nullopt));
    append(std::move(pose));
  }

  ScanTrajectory finish() && {
    if (!track_.poses.empty() && track_.keyframes.back() + 1 < track_.poses.size())
      add_keyframe(std::move(last_cloud_));
    track_.nominal_inlier_ratio /= static_cast<double>(std::max<std::size_t>(1, track_.poses.size() - 1));
    return std::move(track_);
  }

 private:
  std::optional<MotionPrior> select_prior(Stamp stamp, const ScanTimeSpan& time) const {
    if (by_ == ImuUse::kReadings)
      if (auto prior = imu_prior_.predict(stamp, time)) return prior;
    std::optional<Stamp> previous;
    if (!track_.poses.empty()) previous = track_.poses.back().stamp;
    const double max_gap_s = params_.stage.max_odometry_gap_ratio * scan_interval_s_;
    return prior_from_odometry(robot_.odometry, previous, stamp, time, max_gap_s);
  }

  /// Motion since the previous scan, unless only the scans measure it.
  std::optional<SE3> motion_to(Stamp stamp, const std::optional<MotionPrior>& prior) const {
    if (prior && prior->T_previous_body) return prior->T_previous_body;
    if (track_.poses.empty()) return std::nullopt;
    return recorded_motion(track_.poses.back().stamp, stamp);
  }

  /// Recorded motion, also across a gap in the scans, but not if recorded odometry has a longer gap there.
  std::optional<SE3> recorded_motion(Stamp from, Stamp to) const {
    const auto a = robot_.odometry.at(from), b = robot_.odometry.at(to);
    if (!a || !b) return std::nullopt;
    const double max_gap_s =
        std::max(params_.stage.max_odometry_gap_ratio * sample_interval_s_, seconds_between(from, to));
    if (max_sample_gap_s(robot_.odometry, from, to) > max_gap_s) return std::nullopt;
    return a->inverse() * *b;
  }

  /// Adds the motion distortion of this scan and the previous one to the covariance of the step between them.
  void add_distortion_covariance(ScanPose& pose, MotionSource source, const ScanTimeSpan& time) {
    distortion_.add(pose.stamp, pose.T_start_body);
    const SE3::Tangent variances = distortion_.variances(
        source, time, std::min(sample_interval_s_, scan_interval_s_), pose.cloud.median_range_m);
    pose.covariance.diagonal() += previous_distortion_ + variances;
    previous_distortion_ = variances;
  }

  /// Replaces the last keyframe's cloud if its scan started the map and was deskewed again.
  void take_first_cloud(std::optional<ScanPyramid> cloud) {
    if (cloud && !track_.keyframes.empty() && track_.keyframes.back() + 1 == track_.poses.size())
      track_.clouds.back() = *std::move(cloud);
  }

  void forget_start() {
    track_.poses.clear();
    track_.keyframes.clear();
    track_.clouds.clear();
    track_.nominal_inlier_ratio = 0;
    imu_prior_ = ImuMotionPrior(robot_.inertial, params_.inertial);
  }

  void append(ScanPose pose) {
    last_cloud_ = std::exchange(pose.cloud, {});
    track_.nominal_inlier_ratio += pose.inlier_ratio;
    track_.poses.push_back(std::move(pose));
    if (starts_keyframe()) add_keyframe(last_cloud_);
  }

  /// The last pose of the trajectory becomes a keyframe in finish().
  bool starts_keyframe() const {
    if (track_.keyframes.empty()) return true;
    return is_new_keyframe(track_.poses[track_.keyframes.back()].T_start_body,
                           track_.poses.back().T_start_body, keyframes_);
  }

  void add_keyframe(ScanPyramid cloud) {
    track_.keyframes.push_back(track_.poses.size() - 1);
    track_.clouds.push_back(std::move(cloud));
  }

  const Robot& robot_;
  ImuUse by_;
  const ScanParams& params_;
  const KeyframeParams& keyframes_;
  LidarOdometry odometry_;
  ImuMotionPrior imu_prior_;
  double sample_interval_s_, scan_interval_s_;  ///< nominal, of recorded odometry and of scans
  DistortionCovariance distortion_;
  SE3::Tangent previous_distortion_ = SE3::Tangent::Zero();  ///< variances of the last pose
  ScanTrajectory track_;
  ScanPyramid last_cloud_;  ///< of the last pose
};

}  // namespace

ScanTrajectory track_scans(const Robot& robot, std::size_t until, ImuUse by, const ScannerTraits& traits,
                           const ScanParams& params, const KeyframeParams& keyframes,
                           const Progress& progress) {
  ScanTracker tracker(robot, by, traits, params, keyframes);
  for (std::size_t k = 0; k < until; ++k) {
    tracker.add(k);
    report_progress(progress, "scans of " + robot.id,
                    static_cast<double>(k + 1) / static_cast<double>(until));
  }
  return std::move(tracker).finish();
}

ScanKeyframes extract_keyframes(ScanTrajectory& track, const ScannerTraits& traits) {
  ScanKeyframes result;
  result.nominal_inlier_ratio = track.nominal_inlier_ratio;
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
