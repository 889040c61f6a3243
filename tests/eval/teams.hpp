// Small teams for the evaluation tests.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/eval/metrics.hpp"

namespace radioslam::test {

/// A winding path in space: a pose every `period_s` seconds.
inline Trajectory<SE3> winding_path(Rng& rng, std::size_t poses, double period_s) {
  std::vector<StampedPose<SE3>> path;
  SE3 pose =
      SE3::exp((SE3::Tangent() << 5 * rng.normal(), 5 * rng.normal(), rng.normal(), 0, 0, 0).finished());
  for (std::size_t i = 0; i < poses; ++i) {
    path.push_back({Stamp::from_seconds(100 + period_s * static_cast<double>(i)), pose});
    SE3::Tangent step;
    step << 1, 0, 0.05 * rng.normal(), 0.02 * rng.normal(), 0.02 * rng.normal(), 0.4 * rng.normal();
    pose = pose * SE3::exp(step);
  }
  return Trajectory<SE3>(std::move(path));
}

/// `robots` paths named a, b, ...
inline Truth winding_team(std::uint64_t seed, std::size_t robots, std::size_t poses = 40) {
  Rng rng(seed);
  Truth truth;
  for (std::size_t r = 0; r < robots; ++r)
    truth.robots.push_back({std::string(1, static_cast<char>('a' + r)), winding_path(rng, poses, 1)});
  return truth;
}

/// Applies `change` to every pose.
template <class Change>
Trajectory<SE3> changed(const Trajectory<SE3>& path, const Change& change) {
  std::vector<StampedPose<SE3>> poses;
  for (const auto& [stamp, pose] : path) poses.push_back({stamp, change(pose)});
  return Trajectory<SE3>(std::move(poses));
}

/// The truth as an estimate, with `change` applied to every pose.
template <class Change>
std::vector<EstimatedTrajectory> estimate_from(const Truth& truth, const Change& change) {
  std::vector<EstimatedTrajectory> estimate;
  for (const auto& robot : truth.robots) estimate.push_back({robot.id, changed(robot.poses, change)});
  return estimate;
}

/// Errors of up to about a metre and a third of a radian.
inline auto noise(Rng& rng) {
  return [&rng](const SE3& pose) {
    SE3::Tangent xi;
    for (int i = 0; i < 6; ++i) xi[i] = (i < 3 ? 0.4 : 0.1) * rng.normal();
    return pose * SE3::exp(xi);
  };
}

}  // namespace radioslam::test
