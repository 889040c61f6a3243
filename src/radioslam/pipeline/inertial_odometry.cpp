#include "radioslam/pipeline/inertial_odometry.hpp"

#include <utility>

#include "radioslam/inertial/motion_prediction.hpp"

namespace radioslam {

PoseStep scan_step(const ScanPose& from, const ScanPose& to, const InertialStageParams& params) {
  return {from.T_start_body.inverse() * to.T_start_body, to.information, params.outlier_sigmas};
}

std::optional<SE3> InertialGuide::motion_to(Stamp stamp) const {
  if (poses_.empty()) return std::nullopt;
  const StampedPose<SE3>& last = poses_.back();
  const InertialBias bias = filter_ ? filter_->state().bias : InertialBias{};
  const auto readings = preintegrate(*samples_, last.stamp, stamp, bias, params_.noise);
  if (!readings) return std::nullopt;
  if (!filter_)
    return SE3(seconds_between(last.stamp, stamp) * velocity_mps_, readings->motion.rotation);
  const InertialState& state = filter_->state();
  return state.T_world_body.inverse() * state_after(state, readings->motion, params_.noise).T_world_body;
}

void InertialGuide::align() {
  const auto aligned =
      align_gravity(Trajectory<SE3>(poses_), *samples_, params_.noise, params_.alignment);
  if (!aligned) {
    poses_.erase(poses_.begin(), poses_.begin() + static_cast<std::ptrdiff_t>(poses_.size() / 2));
    return;
  }
  InertialState now = aligned->states.back();
  const SE3 T_world_odometry(Eigen::Vector3d::Zero(), aligned->R_world_odometry);
  now.T_world_body = T_world_odometry * poses_.back().pose;
  filter_.emplace(start_prior(now, params_.noise, params_.smoother));
  poses_ = {poses_.back()};
}

void InertialGuide::add(const ScanPose& scan) {
  if (!poses_.empty()) {
    const StampedPose<SE3>& last = poses_.back();
    const double dt_s = seconds_between(last.stamp, scan.stamp);
    const SE3 motion = last.pose.inverse() * scan.T_start_body;
    velocity_mps_ = motion.translation() / dt_s;
    if (filter_) {
      const PoseStep step{motion, scan.information, params_.stage.outlier_sigmas};
      auto readings = preintegrate(*samples_, last.stamp, scan.stamp, filter_->state().bias, params_.noise);
      filter_->advance(state_step(step, std::move(readings), dt_s), params_.noise);
      poses_.clear();
    }
  }
  poses_.push_back({scan.stamp, scan.T_start_body});
  if (!filter_ && seconds_between(poses_.front().stamp, scan.stamp) >= params_.alignment.window_s) align();
}

std::optional<InertialOdometry> smooth_scans(const std::vector<ScanPose>& scans,
                                             const std::vector<InertialSample>& samples,
                                             const InertialParams& params) {
  std::vector<StampedPose<SE3>> poses;
  InertialDrive drive;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    poses.push_back({scans[k].stamp, scans[k].T_start_body});
    drive.stamps.push_back(scans[k].stamp);
    if (k > 0) drive.steps.push_back(scan_step(scans[k - 1], scans[k], params.stage));
  }
  const auto aligned = align_gravity(Trajectory<SE3>(poses), samples, params.noise, params.alignment);
  if (!aligned) return std::nullopt;
  drive.start = aligned->states.front();
  const auto smoothed = smooth_inertially(drive, samples, params.noise, params.smoother);
  if (!smoothed) return std::nullopt;
  InertialOdometry odometry;
  for (const InertialState& state : smoothed->states) odometry.poses.push_back(state.T_world_body);
  odometry.steps = odometry_noise_of_states(*smoothed, params.odometry_noise);
  return odometry;
}

}  // namespace radioslam
