#include "radioslam/odometry/lidar_inertial_smoothing.hpp"

#include <algorithm>

#include "radioslam/inertial/preintegration.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/odometry/map_drift.hpp"

namespace radioslam {
namespace {

/// Result of smoothing; z is up.
struct InertialOdometry {
  std::vector<SE3> poses;                ///< of the scans
  std::vector<OdometryStepNoise> steps;  ///< between successive states
  double cost_per_step = 0;              ///< squared norm of the residuals per step
};

SE3::Jacobian drift_between(const ScanPoses& scans, std::size_t from, std::size_t to,
                            const InertialStageParams& params) {
  MapDrift drift(scans[from], params);
  for (std::size_t k = from + 1; k <= to; ++k) drift.add(scans[k]);
  return drift.covariance();
}

/// Indices of the scans with a state: the first, the last, those at least `node_s` after the previous one,
/// and the scans on either side of a new map's start.
std::vector<std::size_t> nodes_of(const ScanPoses& scans, double node_s) {
  std::vector<std::size_t> nodes;
  for (std::size_t k = 0; k < scans.size(); ++k)
    if (nodes.empty() || k + 1 == scans.size() || scans[k].status == ScanStatus::kNewMap ||
        scans[k + 1].status == ScanStatus::kNewMap ||
        seconds_between(scans[nodes.back()].stamp, scans[k].stamp) >= node_s)
      nodes.push_back(k);
  return nodes;
}

/// The body's poses at the scans, starting from `state`, by the IMU, or by the scans if IMU samples are
/// missing.
std::vector<SE3> path_from(const InertialState& state, const std::vector<StampedPose<SE3>>& scans,
                           const std::vector<ImuSample>& samples, const ImuNoiseParams& noise) {
  std::vector<Stamp> stamps;
  for (const auto& scan : scans) stamps.push_back(scan.stamp);
  std::vector<SE3> path;
  if (const auto states = predict_motion(state, stamps.front(), samples, stamps, noise))
    for (const InertialState& there : *states) path.push_back(there.T_world_body);
  else
    for (const auto& scan : scans)
      path.push_back(state.T_world_body * scans.front().pose.inverse() * scan.pose);
  return path;
}

/// The body's poses at all scans: the predicted path between nodes, its end error spread evenly in time.
std::vector<SE3> poses_through(const ScanPoses& scans, const std::vector<std::size_t>& nodes,
                               const std::vector<InertialState>& states,
                               const std::vector<ImuSample>& samples, const ImuNoiseParams& noise) {
  std::vector<SE3> poses{states.front().T_world_body};
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    std::vector<StampedPose<SE3>> span;
    for (std::size_t k = nodes[n - 1]; k <= nodes[n]; ++k)
      span.push_back({scans[k].stamp, scans[k].T_start_body});
    const std::vector<SE3> path = path_from(states[n - 1], span, samples, noise);
    const SE3::Tangent missing = (path.back().inverse() * states[n].T_world_body).log();
    const double duration_s = seconds_between(span.front().stamp, span.back().stamp);
    for (std::size_t k = 1; k < path.size(); ++k)
      poses.push_back(path[k] *
                      SE3::exp(seconds_between(span.front().stamp, span[k].stamp) / duration_s * missing));
  }
  return poses;
}

/// Nothing if gravity cannot be estimated or the smoother refuses.
std::optional<InertialOdometry> smooth_scans(const ScanPoses& scans, const std::vector<ImuSample>& samples,
                                             const InertialParams& params) {
  const auto aligned = align_gravity(trajectory_of(scans), samples, params.noise, params.alignment);
  if (!aligned) return std::nullopt;
  const auto nodes = nodes_of(scans, params.stage.node_s);
  InertialDrive drive;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    drive.stamps.push_back(scans[nodes[n]].stamp);
    drive.poses.push_back(map_pose(scans[nodes[n]], params.stage));
    if (n > 0) drive.map_drifts.push_back(drift_between(scans, nodes[n - 1], nodes[n], params.stage));
  }
  drive.start = aligned->states.front();
  const auto smoothed = smooth_inertially(drive, samples, params.noise, params.smoother);
  if (!smoothed) return std::nullopt;
  return InertialOdometry{
      poses_through(scans, nodes, smoothed->states, samples, params.noise),
      odometry_noise_inflation(*smoothed, params.odometry_noise),
      smoothed->cost / static_cast<double>(std::max<std::size_t>(1, drive.map_drifts.size()))};
}

}  // namespace

std::optional<std::string> smooth_with_imu(ScanTrajectory& track, const std::vector<ImuSample>& samples,
                                           const InertialParams& params) {
  const auto smoothed = smooth_scans(track.poses, samples, params);
  if (!smoothed) return "gravity could not be estimated from its IMU data and scans";
  if (smoothed->cost_per_step > params.stage.max_cost_per_step) return "its IMU data contradicts its scans";
  for (std::size_t k = 0; k < track.poses.size(); ++k) {
    track.poses[k].T_start_body = smoothed->poses[k];
    if (k == 0) continue;
    const Stamp begin = track.poses[k - 1].stamp, end = track.poses[k].stamp;
    track.poses[k].covariance = measured_covariance(smoothed->steps, begin, end);
  }
  track.is_level = true;
  return std::nullopt;
}

}  // namespace radioslam
