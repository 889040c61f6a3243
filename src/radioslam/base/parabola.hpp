// Where a peak lies between the steps of a table.
#pragma once

namespace radioslam {

/// The peak of the parabola through three values at successive steps, in steps from the middle one; 0 where
/// they do not bend down.
inline double parabola_peak(double before, double here, double after) {
  const double bend = before - 2 * here + after;
  return bend < 0 ? (before - after) / (2 * bend) : 0;
}

}  // namespace radioslam
