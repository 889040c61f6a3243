// IMU samples as intervals of constant rate and force: between successive samples, with the mean of both.
//
// The ends of the requested time are interpolated; before the first (after the last) sample its values hold.
// Refuses gaps longer than `max_gap_s` without a sample, at the ends as well.
// Cost: samples in between, and a binary search.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/mission/inertial.hpp"

namespace radioslam {

struct ImuInterval {
  double duration_s = 0;
  Eigen::Vector3d angular_rate_radps;
  Eigen::Vector3d specific_force_mps2;
};

/// Intervals from `from` to `to`, in order; `samples` are sorted by time and `from` <= `to`.
std::optional<std::vector<ImuInterval>> imu_intervals(const std::vector<ImuSample>& samples, Stamp from,
                                                      Stamp to, double max_gap_s);

}  // namespace radioslam
