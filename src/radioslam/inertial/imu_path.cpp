#include "radioslam/inertial/imu_path.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

/// From a pose, at the samples until the next one, and there.
struct Path {
  std::vector<Stamp> stamps;
  std::vector<InertialState> states;

  double duration_s() const { return seconds_between(stamps.front(), stamps.back()); }
};

/// Nothing without samples in between, or with too long a gap.
std::optional<Path> path_between(const StampedPose<SE3>& a, const StampedPose<SE3>& b,
                                 const std::vector<ImuSample>& samples, const InertialBias& bias,
                                 const ImuNoiseParams& params) {
  Path path{{a.stamp}, {}};
  auto sample = std::upper_bound(samples.begin(), samples.end(), a.stamp,
                                 [](Stamp stamp, const ImuSample& of) { return stamp < of.stamp; });
  for (; sample != samples.end() && sample->stamp < b.stamp; ++sample) path.stamps.push_back(sample->stamp);
  if (path.stamps.size() == 1) return std::nullopt;
  path.stamps.push_back(b.stamp);
  auto states = predict_motion({a.pose, {}, bias}, a.stamp, samples, path.stamps, params);
  if (!states) return std::nullopt;
  path.states = *std::move(states);
  const SE3 end = path.states.back().T_world_body;
  const Eigen::Vector3d velocity_mps = (b.pose.translation() - end.translation()) / path.duration_s();
  const Eigen::Vector3d missing = so3_log(end.rotation().conjugate() * b.pose.rotation());
  for (std::size_t k = 0; k < path.stamps.size(); ++k) {
    const double t = seconds_between(a.stamp, path.stamps[k]);
    InertialState& there = path.states[k];
    there.velocity_mps += velocity_mps;
    there.T_world_body = SE3(there.T_world_body.translation() + t * velocity_mps,
                             there.T_world_body.rotation() * so3_exp(t / path.duration_s() * missing));
  }
  return path;
}

/// Calls `take` with every row of `poses`, and the path before it by the IMU if there is one.
template <class Take>
void follow(const Trajectory<SE3>& poses, Stamp first, Stamp last, const std::vector<ImuSample>& samples,
            const InertialBias& bias, const ImuNoiseParams& params, const Take& take) {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const bool is_within = k > 0 && first <= poses[k - 1].stamp && poses[k].stamp <= last;
    take(poses[k], is_within ? path_between(poses[k - 1], poses[k], samples, bias, params) : std::nullopt);
  }
}

InertialBias bias_of(const Trajectory<SE3>& poses, Stamp first, Stamp last,
                     const std::vector<ImuSample>& samples, const ImuNoiseParams& params) {
  std::array<std::vector<double>, 3> seen_mps2;
  std::optional<Path> before;
  follow(poses, first, last, samples, {}, params, [&](const auto&, std::optional<Path> path) {
    if (before && path) {
      const Eigen::Vector3d jump = path->states.front().velocity_mps - before->states.back().velocity_mps;
      const Eigen::Vector3d bias = before->states.back().T_world_body.rotation().conjugate() * jump /
                                   (-0.5 * (before->duration_s() + path->duration_s()));
      for (std::size_t axis = 0; axis < 3; ++axis)
        seen_mps2[axis].push_back(bias[static_cast<Eigen::Index>(axis)]);
    }
    before = std::move(path);
  });
  InertialBias bias;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!seen_mps2[axis].empty())
      bias.accelerometer_mps2[static_cast<Eigen::Index>(axis)] = upper_median(std::move(seen_mps2[axis]));
  return bias;
}

}  // namespace

Trajectory<SE3> with_imu_path(const Trajectory<SE3>& poses, Stamp first, Stamp last,
                              const std::vector<ImuSample>& samples, const ImuNoiseParams& params) {
  const InertialBias bias = bias_of(poses, first, last, samples, params);
  std::vector<StampedPose<SE3>> rows;
  follow(poses, first, last, samples, bias, params, [&](const auto& pose, const std::optional<Path>& path) {
    for (std::size_t k = 1; path && k + 1 < path->stamps.size(); ++k)
      rows.push_back({path->stamps[k], path->states[k].T_world_body});
    rows.push_back(pose);
  });
  return Trajectory<SE3>(std::move(rows));
}

}  // namespace radioslam
