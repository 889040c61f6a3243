#include "radioslam/pipeline/inertial_odometry.hpp"

#include <utility>

#include "radioslam/inertial/motion_prediction.hpp"

namespace radioslam {

PoseStep scan_step(const ScanPose& from, const ScanPose& to, const InertialStageParams& params) {
  return {from.T_start_body.inverse() * to.T_start_body, to.information, params.outlier_sigmas};
}

std::optional<InertialState> InertialGuide::predicted(Stamp stamp) const {
  const InertialState& state = filter_->state();
  if (stamp == node_.stamp) return state;
  const auto readings = preintegrate(*samples_, node_.stamp, stamp, state.bias, params_.noise);
  if (!readings) return std::nullopt;
  return state_after(state, readings->motion, params_.noise);
}

std::optional<SE3> InertialGuide::motion_to(Stamp stamp) const {
  if (empty_) return std::nullopt;
  if (filter_) {
    const auto now = predicted(last_.stamp), then = predicted(stamp);
    if (!now || !then) return std::nullopt;
    return now->T_world_body.inverse() * then->T_world_body;
  }
  const auto readings = preintegrate(*samples_, last_.stamp, stamp, {}, params_.noise);
  if (!readings) return std::nullopt;
  return SE3(seconds_between(last_.stamp, stamp) * velocity_mps_, readings->motion.rotation);
}

void InertialGuide::align() {
  const auto aligned = align_gravity(Trajectory<SE3>(poses_), *samples_, params_.noise, params_.alignment);
  if (!aligned) {
    poses_.erase(poses_.begin(), poses_.begin() + std::ssize(poses_) / 2);
    return;
  }
  filter_.emplace(start_prior(aligned->states.back(), params_.noise, params_.smoother));
  node_ = poses_.back();
  poses_.clear();
}

void InertialGuide::add(const ScanPose& scan) {
  if (!empty_)
    velocity_mps_ =
        (last_.pose.inverse() * scan.T_start_body).translation() / seconds_between(last_.stamp, scan.stamp);
  empty_ = false;
  last_ = {scan.stamp, scan.T_start_body};
  if (!filter_) {
    poses_.push_back(last_);
    if (seconds_between(poses_.front().stamp, scan.stamp) >= params_.alignment.window_s) align();
    return;
  }
  const double dt_s = seconds_between(node_.stamp, scan.stamp);
  if (dt_s < params_.stage.node_s && scan.outcome != ScanOutcome::kNewMap) return;
  const PoseStep step{node_.pose.inverse() * scan.T_start_body, scan.information,
                      params_.stage.outlier_sigmas};
  auto readings = preintegrate(*samples_, node_.stamp, scan.stamp, filter_->state().bias, params_.noise);
  filter_->advance(state_step(step, std::move(readings), dt_s), params_.noise);
  node_ = last_;
}

namespace {

/// The scans that states stand at: the first, the last, and those at least so long after the one before; and
/// those on either side of where a new map was begun.
std::vector<std::size_t> nodes_of(const std::vector<ScanPose>& scans, double node_s) {
  std::vector<std::size_t> nodes;
  for (std::size_t k = 0; k < scans.size(); ++k)
    if (nodes.empty() || k + 1 == scans.size() || scans[k].outcome == ScanOutcome::kNewMap ||
        scans[k + 1].outcome == ScanOutcome::kNewMap ||
        seconds_between(scans[nodes.back()].stamp, scans[k].stamp) >= node_s)
      nodes.push_back(k);
  return nodes;
}

/// The scans' poses, held to the states at the nodes: what is missing from one to the next is spread evenly.
std::vector<SE3> bent(const std::vector<ScanPose>& scans, const std::vector<std::size_t>& nodes,
                      const std::vector<InertialState>& states) {
  std::vector<SE3> poses{states.front().T_world_body};
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    const std::size_t begin = nodes[n - 1], end = nodes[n];
    const SE3 &T_begin = states[n - 1].T_world_body, &T_end = states[n].T_world_body;
    const SE3 from_begin = scans[begin].T_start_body.inverse();
    const SE3::Tangent missing =
        ((from_begin * scans[end].T_start_body).inverse() * T_begin.inverse() * T_end).log();
    for (std::size_t k = begin + 1; k <= end; ++k) {
      const double share = seconds_between(scans[begin].stamp, scans[k].stamp) /
                           seconds_between(scans[begin].stamp, scans[end].stamp);
      poses.push_back(T_begin * from_begin * scans[k].T_start_body * SE3::exp(share * missing));
    }
  }
  return poses;
}

}  // namespace

std::optional<InertialOdometry> smooth_scans(const std::vector<ScanPose>& scans,
                                             const std::vector<InertialSample>& samples,
                                             const InertialParams& params) {
  std::vector<StampedPose<SE3>> poses;
  for (const ScanPose& scan : scans) poses.push_back({scan.stamp, scan.T_start_body});
  const auto aligned = align_gravity(Trajectory<SE3>(poses), samples, params.noise, params.alignment);
  if (!aligned) return std::nullopt;
  const auto nodes = nodes_of(scans, params.stage.node_s);
  InertialDrive drive;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    drive.stamps.push_back(scans[nodes[n]].stamp);
    if (n > 0) drive.steps.push_back(scan_step(scans[nodes[n - 1]], scans[nodes[n]], params.stage));
  }
  drive.start = aligned->states.front();
  const auto smoothed = smooth_inertially(drive, samples, params.noise, params.smoother);
  if (!smoothed) return std::nullopt;
  return InertialOdometry{bent(scans, nodes, smoothed->states),
                          odometry_noise_of_states(*smoothed, params.odometry_noise)};
}

}  // namespace radioslam
