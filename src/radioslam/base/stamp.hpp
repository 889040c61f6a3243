// Time as whole nanoseconds on the mission's one clock.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace radioslam {

/// A point in time; the zero is the mission's own.
struct Stamp {
  std::int64_t ns = 0;

  static Stamp from_seconds(double seconds) {
    return {static_cast<std::int64_t>(std::llround(seconds * 1e9))};
  }
  double seconds() const { return static_cast<double>(ns) * 1e-9; }
  auto operator<=>(const Stamp&) const = default;
};

/// Seconds from `earlier` to `later`, exact to a nanosecond even for stamps of the Unix epoch.
inline double seconds_between(Stamp earlier, Stamp later) {
  return static_cast<double>(later.ns - earlier.ns) * 1e-9;
}

}  // namespace radioslam
