#include "radioslam/odometry/imu_motion_prior.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {
namespace {

/// Poses of a body with these states' rotations and a constant velocity in its own frame.
std::vector<SE3> dead_reckon_with_gyro(const std::vector<InertialState>& states,
                                       const std::vector<Stamp>& stamps,
                                       const Eigen::Vector3d& velocity_mps) {
  std::vector<SE3> path{SE3({0, 0, 0}, states.front().T_world_body.rotation())};
  for (std::size_t k = 1; k < states.size(); ++k) {
    const SE3 turned({0, 0, 0},
                     states[k - 1].T_world_body.rotation().conjugate() * states[k].T_world_body.rotation());
    SE3::Tangent step = turned.log();
    step.head<3>() = seconds_between(stamps[k - 1], stamps[k]) * velocity_mps;
    path.push_back(path.back() * SE3::exp(step));
  }
  return path;
}

StampedPose<SE3> middle_of(const ScanPose& scan, const ScanMotion& motion) {
  return {{scan.stamp.ns + Stamp::from_seconds(motion.time.middle_s).ns},
          scan.T_start_body * motion.middle()};
}

}  // namespace

double max_sample_gap_s(const Trajectory<SE3>& samples, Stamp begin, Stamp end) {
  double max_s = 0;
  if (samples.size() < 2) return max_s;
  for (std::size_t k = samples.segment(begin); k + 1 < samples.size() && samples[k].stamp < end; ++k)
    max_s = std::max(max_s, seconds_between(samples[k].stamp, samples[k + 1].stamp));
  return max_s;
}

std::optional<MotionPrior> prior_from_odometry(const Trajectory<SE3>& odometry, std::optional<Stamp> previous,
                                               Stamp stamp, const ScanTimeSpan& time, double max_gap_s) {
  const auto at = [&](double after_s) { return Stamp{stamp.ns + Stamp::from_seconds(after_s).ns}; };
  const Stamp begin = std::min({stamp, previous.value_or(stamp), at(time.first_s)});
  const Stamp end = std::max(stamp, at(time.last_s));
  if (!odometry.covers(begin) || !odometry.covers(end)) return std::nullopt;
  if (max_sample_gap_s(odometry, begin, end) > max_gap_s) return std::nullopt;
  const SE3 T_body_any = odometry.at(stamp)->inverse();
  MotionPrior prior{MotionSource::kOdometry, {}, ScanMotion::over(time)};
  ScanMotion& motion = prior.scan_motion;
  for (std::size_t k = 0; k < motion.poses.size(); ++k)
    motion.poses[k] = T_body_any * *odometry.at(at(motion.time_of(k)));
  if (previous) prior.T_previous_body = (T_body_any * *odometry.at(*previous)).inverse();
  return prior;
}

std::optional<std::vector<SE3>> ImuMotionPrior::predict_path(const std::vector<Stamp>& stamps) const {
  const InertialState start = filter_ ? filter_->state() : InertialState{};
  const Stamp from = filter_ ? state_stamp_ : stamps.front();
  const auto states = predict_motion(start, from, *samples_, stamps, params_.noise);
  if (!states) return std::nullopt;
  if (!filter_) return dead_reckon_with_gyro(*states, stamps, *velocity_mps_);
  std::vector<SE3> path;
  for (const InertialState& state : *states) path.push_back(state.T_world_body);
  return path;
}

std::optional<MotionPrior> ImuMotionPrior::predict(Stamp stamp, const ScanTimeSpan& time) const {
  if (!velocity_mps_) return std::nullopt;
  MotionPrior prior{MotionSource::kImu, {}, ScanMotion::over(time)};
  ScanMotion& motion = prior.scan_motion;
  std::vector<Stamp> stamps{stamp};
  for (std::size_t k = 0; k < motion.poses.size(); ++k)
    stamps.push_back({stamp.ns + Stamp::from_seconds(motion.time_of(k)).ns});
  if (last_) stamps.push_back(last_->stamp);
  if (filter_)  // it does not predict backwards
    for (Stamp& at : stamps) at = std::max(at, state_stamp_);
  std::vector<Stamp> sorted = stamps;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const auto path = predict_path(sorted);
  if (!path) return std::nullopt;
  const auto pose_at = [&](Stamp at) -> const SE3& {
    return (
        *path)[static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), at) - sorted.begin())];
  };
  const SE3 T_body_any = pose_at(stamp).inverse();
  for (std::size_t k = 0; k < motion.poses.size(); ++k) motion.poses[k] = T_body_any * pose_at(stamps[k + 1]);
  if (last_) prior.T_previous_body = (T_body_any * pose_at(stamps.back())).inverse();
  return prior;
}

void ImuMotionPrior::align(const ScanPose& scan) {
  const auto aligned = align_gravity(Trajectory<SE3>(poses_), *samples_, params_.noise, params_.alignment);
  if (!aligned) {
    poses_.erase(poses_.begin(), poses_.begin() + std::ssize(poses_) / 2);
    return;
  }
  filter_.emplace(
      start_prior(aligned->states.back(), map_pose(scan, params_.stage), params_.noise, params_.smoother));
  state_stamp_ = scan.stamp;
  poses_.clear();
}

void ImuMotionPrior::update_velocity(const StampedPose<SE3>& middle) {
  if (middle_ && middle_->stamp < middle.stamp)
    velocity_mps_ = (middle_->pose.inverse() * middle.pose).log().head<3>() /
                    seconds_between(middle_->stamp, middle.stamp);
  middle_ = middle;
}

void ImuMotionPrior::add(const ScanPose& scan, const std::optional<MotionPrior>& prior) {
  last_ = {scan.stamp, scan.T_start_body};
  update_velocity(prior ? middle_of(scan, prior->scan_motion) : *last_);
  if (!filter_) {
    poses_.push_back(*last_);
    if (seconds_between(poses_.front().stamp, scan.stamp) >= params_.alignment.window_s) align(scan);
    if (filter_) drift_.emplace(scan, params_.stage);
    return;
  }
  drift_->add(scan);
  const double dt_s = seconds_between(state_stamp_, scan.stamp);
  if (dt_s < params_.stage.node_s && scan.status != ScanStatus::kNewMap) return;
  auto readings = preintegrate(*samples_, state_stamp_, scan.stamp, filter_->state().bias, params_.noise);
  const StateStep step =
      state_step(map_pose(scan, params_.stage), drift_->covariance(), std::move(readings), dt_s);
  if (filter_->advance(step, params_.noise) != InertialFilter::Advance::kDone) return;
  state_stamp_ = scan.stamp;
  drift_.emplace(scan, params_.stage);
}

}  // namespace radioslam
