// Peak interpolation between equidistant samples by a parabola.
#pragma once

namespace radioslam {

/// The peak of the parabola through three values at successive steps, in steps from the middle one; 0 if
/// they are not concave.
inline double parabola_peak(double before, double here, double after) {
  const double curvature = before - 2 * here + after;
  return curvature < 0 ? (before - after) / (2 * curvature) : 0;
}

}  // namespace radioslam
