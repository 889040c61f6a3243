#include "radioslam/odometry/scan_tracker.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {

ScanTracker::ScanTracker(const SensorHistory& history, ImuUse by, const ScannerTraits& traits,
                         const ScanParams& params, const KeyframeParams& keyframes, CloudStore& clouds)
    : history_(history),
      by_(by),
      params_(params),
      keyframes_(keyframes),
      clouds_(clouds),
      odometry_(traits, params.lidar),
      imu_prior_(history.inertial(), params.inertial),
      distortion_(params.stage.acceleration_smoothing, history.scan_interval_s()) {}

void ScanTracker::add(Stamp stamp, LidarScan scan) {
  const ScanTimeSpan time = time_span(scan, params_.lidar.points);
  const std::optional<MotionPrior> prior = select_prior(stamp, time);
  const std::optional<SE3> motion = motion_to(stamp, prior);
  if (prior) scan = deskew(std::move(scan), prior->scan_motion, params_.lidar.points);
  ScanPose pose =
      odometry_.register_scan(stamp, scan, motion, prior ? prior->source : MotionSource::kOdometry,
                              motion ? recorded_covariance(stamp) : SE3::Jacobian::Zero());
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

ScanTrajectory ScanTracker::finish() && {
  if (!track_.poses.empty() && track_.keyframes.back() + 1 < track_.poses.size()) add_keyframe();
  track_.nominal_inlier_ratio /= static_cast<double>(std::max<std::size_t>(1, track_.poses.size() - 1));
  return std::move(track_);
}

std::optional<MotionPrior> ScanTracker::select_prior(Stamp stamp, const ScanTimeSpan& time) const {
  if (by_ == ImuUse::kReadings)
    if (auto prior = imu_prior_.predict(stamp, time)) return prior;
  std::optional<Stamp> previous;
  if (!track_.poses.empty()) previous = track_.poses.back().stamp;
  const double max_gap_s = params_.stage.max_odometry_gap_ratio * history_.scan_interval_s();
  return prior_from_odometry(history_.robot().odometry, previous, stamp, time, max_gap_s);
}

/// Motion since the previous scan, unless only the scans measure it.
std::optional<SE3> ScanTracker::motion_to(Stamp stamp, const std::optional<MotionPrior>& prior) const {
  if (prior && prior->T_previous_body) return prior->T_previous_body;
  if (track_.poses.empty()) return std::nullopt;
  return recorded_motion(track_.poses.back().stamp, stamp);
}

/// Recorded motion, also across a gap in the scans. Across a gap in the recorded odometry, too, if the robot
/// has been as fast before: what counts the wheels' turns may go on where the recording pauses.
std::optional<SE3> ScanTracker::recorded_motion(Stamp from, Stamp to) const {
  const Trajectory<SE3>& odometry = history_.robot().odometry;
  const auto a = odometry.at(from), b = odometry.at(to);
  if (!a || !b) return std::nullopt;
  const SE3 motion = a->inverse() * *b;
  const double max_gap_s = std::max(params_.stage.max_odometry_gap_ratio * history_.sample_interval_s(),
                                    params_.lidar.odometry.max_lost_scans * history_.scan_interval_s());
  const bool is_whole = max_sample_gap_s(odometry, from, to) <= max_gap_s;
  if (!is_whole && !history_.has_been_as_fast(motion, seconds_between(from, to))) return std::nullopt;
  return motion;
}

/// Of the recorded motion since the previous scan, if that was some time ago; zero if it is not recorded.
SE3::Jacobian ScanTracker::recorded_covariance(Stamp stamp) const {
  if (track_.poses.empty()) return SE3::Jacobian::Zero();
  const Stamp previous = track_.poses.back().stamp;
  if (seconds_between(previous, stamp) < 2 * history_.scan_interval_s())
    return SE3::Jacobian::Zero();  // no gap
  if (!history_.robot().odometry.covers(previous) || !history_.robot().odometry.covers(stamp))
    return SE3::Jacobian::Zero();
  return odometry_between<SE3>(history_.robot(), previous, stamp).covariance;
}

/// Variances of the recorded motion from the stamp to the middle of the sweep: the points know the pose
/// there.
SE3::Tangent ScanTracker::noise_to_middle(Stamp stamp, const ScanTimeSpan& time) const {
  const Stamp middle{stamp.ns + Stamp::from_seconds(time.middle_s).ns};
  const Trajectory<SE3>& odometry = history_.robot().odometry;
  if (!odometry.covers(stamp) || !odometry.covers(middle)) return SE3::Tangent::Zero();
  return odometry_between<SE3>(history_.robot(), stamp, middle).covariance.diagonal();
}

/// Adds the motion distortion of this scan and the previous one to the covariance of the step between them.
void ScanTracker::add_distortion_covariance(ScanPose& pose, MotionSource source, const ScanTimeSpan& time) {
  distortion_.add(pose.stamp, pose.T_start_body);
  SE3::Tangent variances =
      distortion_.variances(source, time, std::min(history_.sample_interval_s(), history_.scan_interval_s()),
                            pose.cloud.median_range_m);
  if (source == MotionSource::kOdometry) variances += noise_to_middle(pose.stamp, time);
  pose.covariance.diagonal() += previous_distortion_ + variances;
  previous_distortion_ = variances;
}

/// Replaces the last keyframe's cloud if its scan started the map and was deskewed again.
void ScanTracker::take_first_cloud(const std::optional<ScanPyramid>& cloud) {
  if (cloud && !track_.keyframes.empty() && track_.keyframes.back() + 1 == track_.poses.size())
    track_.clouds.back() = clouds_.add(*cloud);
}

void ScanTracker::forget_start() {
  track_.poses.clear();
  track_.keyframes.clear();
  track_.clouds.clear();
  track_.nominal_inlier_ratio = 0;
  imu_prior_ = ImuMotionPrior(history_.inertial(), params_.inertial);
}

void ScanTracker::append(ScanPose pose) {
  last_cloud_ = std::exchange(pose.cloud, {});
  track_.nominal_inlier_ratio += pose.inlier_ratio;
  track_.poses.push_back(std::move(pose));
  if (starts_keyframe()) add_keyframe();
}

/// The last pose of the trajectory becomes a keyframe in finish().
bool ScanTracker::starts_keyframe() const {
  if (track_.keyframes.empty()) return true;
  return is_new_keyframe(track_.poses[track_.keyframes.back()].T_start_body, track_.poses.back().T_start_body,
                         keyframes_);
}

void ScanTracker::add_keyframe() {
  track_.keyframes.push_back(track_.poses.size() - 1);
  track_.clouds.push_back(clouds_.add(last_cloud_));
}

}  // namespace radioslam
