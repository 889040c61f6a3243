// Angles of phases in tests.
#pragma once

#include <cmath>
#include <numbers>

namespace radioslam {

inline constexpr double kPi = std::numbers::pi;

/// In [-pi, pi].
inline double wrapped(double angle_rad) { return std::remainder(angle_rad, 2 * kPi); }

}  // namespace radioslam
