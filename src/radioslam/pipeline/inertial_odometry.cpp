#include "radioslam/pipeline/inertial_odometry.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "radioslam/inertial/motion_prediction.hpp"
#include "radioslam/pipeline/map_drift.hpp"

namespace radioslam {

namespace {

SE3::Jacobian drift_between(const std::vector<ScanPose>& scans, std::size_t from, std::size_t to,
                            const InertialStageParams& params) {
  MapDrift drift(scans[from], params);
  for (std::size_t k = from + 1; k <= to; ++k) drift.add(scans[k]);
  return drift.covariance();
}

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

/// The way of the body over some scans from the first of them on, by the readings, or by the scans where
/// readings are missing.
std::vector<SE3> way_from(const InertialState& state, std::span<const ScanPose> scans,
                          const std::vector<InertialSample>& samples, const InertialNoiseParams& noise) {
  std::vector<Stamp> stamps;
  for (const ScanPose& scan : scans) stamps.push_back(scan.stamp);
  std::vector<SE3> way;
  if (const auto states = predict_motion(state, stamps.front(), samples, stamps, noise))
    for (const InertialState& there : *states) way.push_back(there.T_world_body);
  else
    for (const ScanPose& scan : scans)
      way.push_back(state.T_world_body * scans.front().T_start_body.inverse() * scan.T_start_body);
  return way;
}

/// The body's poses at the scans: its way from each node to the next, and what is missing there spread
/// evenly.
std::vector<SE3> poses_through(const std::vector<ScanPose>& scans, const std::vector<std::size_t>& nodes,
                               const std::vector<InertialState>& states,
                               const std::vector<InertialSample>& samples, const InertialNoiseParams& noise) {
  std::vector<SE3> poses{states.front().T_world_body};
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    const std::span<const ScanPose> span(scans.data() + nodes[n - 1], nodes[n] - nodes[n - 1] + 1);
    const std::vector<SE3> way = way_from(states[n - 1], span, samples, noise);
    const SE3::Tangent missing = (way.back().inverse() * states[n].T_world_body).log();
    const double duration_s = seconds_between(span.front().stamp, span.back().stamp);
    for (std::size_t k = 1; k < way.size(); ++k)
      poses.push_back(way[k] *
                      SE3::exp(seconds_between(span.front().stamp, span[k].stamp) / duration_s * missing));
  }
  return poses;
}

}  // namespace

std::optional<InertialOdometry> smooth_scans(const std::vector<ScanPose>& scans,
                                             const std::vector<InertialSample>& samples,
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
      odometry_noise_of_states(*smoothed, params.odometry_noise),
      smoothed->cost / static_cast<double>(std::max<std::size_t>(1, drive.map_drifts.size()))};
}

}  // namespace radioslam
