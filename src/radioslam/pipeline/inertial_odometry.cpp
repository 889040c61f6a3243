#include "radioslam/pipeline/inertial_odometry.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {

PoseStep scan_step(const ScanPose& from, const ScanPose& to, const InertialStageParams& params) {
  return {from.T_start_body.inverse() * to.T_start_body, to.information, params.outlier_sigmas};
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
                          odometry_noise_of_states(*smoothed, params.odometry_noise),
                          smoothed->cost / static_cast<double>(std::max<std::size_t>(1, drive.steps.size()))};
}

}  // namespace radioslam
