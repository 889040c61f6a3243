// Conversions between units. Nanoseconds are whole numbers, as in Stamp; the other factors are doubles.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace radioslam {

inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
inline constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
inline constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;
inline constexpr std::int64_t kMicrosecondsPerSecond = 1'000'000;
inline constexpr double kMillisecondsPerSecond = 1e3;
inline constexpr double kSecondsPerMillisecond = 1e-3;
inline constexpr double kSecondsPerMicrosecond = 1e-6;
inline constexpr double kSecondsPerNanosecond = 1e-9;
inline constexpr int kSecondsPerMinute = 60;
inline constexpr int kSecondsPerHour = 3600;

inline constexpr double kHzPerMhz = 1e6;
inline constexpr double kMetresPerMillimetre = 1e-3;

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180;
inline constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

/// Multiply first: for many round numbers of degrees this is closer than their product with
/// kRadiansPerDegree.
constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180; }
constexpr double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// Decibels of a ratio of powers, and back.
inline double decibels(double power_ratio) { return 10 * std::log10(power_ratio); }
inline double power_ratio(double decibels) { return std::pow(10, decibels / 10); }

}  // namespace radioslam
