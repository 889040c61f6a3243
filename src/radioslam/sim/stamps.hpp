// Stamps of recordings at a rate, in whole milliseconds, and the names of robots.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

inline constexpr std::int64_t kMillisecond_ns = 1000000;

/// Stamps from `begin_s` to `end_s` at a rate.
std::vector<Stamp> regular_stamps(double begin_s, double end_s, double rate_hz);

/// a, b, ..., z, a1, b1, ...
std::string robot_id(std::size_t index);

}  // namespace radioslam
