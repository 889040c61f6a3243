// Inertial readings as pieces over which they count as constant: between one reading and the next, with the
// mean of both; the ends of the time asked for are interpolated.
// A time before the first (after the last) reading has that reading's values.
// Refuses where more than `longest_gap_s` passes without a reading, at the ends too.
// Cost: readings in between, and a binary search.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/mission/inertial.hpp"

namespace radioslam {

struct ReadingInterval {
  double duration_s = 0;
  Eigen::Vector3d angular_rate_radps;
  Eigen::Vector3d specific_force_mps2;
};

/// The pieces from `from` to `to`, in order; `samples` run forward in time and `from` <= `to`.
std::optional<std::vector<ReadingInterval>> reading_intervals(const std::vector<InertialSample>& samples,
                                                              Stamp from, Stamp to, double longest_gap_s);

}  // namespace radioslam
