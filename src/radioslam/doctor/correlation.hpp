// Sums over pairs (x, y), from which their correlation and the line through them follow.
#pragma once

namespace radioslam {

struct CorrelationSums {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  void add(double of_x, double of_y) {
    n += 1, x += of_x, y += of_y, xx += of_x * of_x, yy += of_y * of_y, xy += of_x * of_y;
  }
  /// n^2 times the variances and the covariance.
  double spread_x() const { return n * xx - x * x; }
  double spread_y() const { return n * yy - y * y; }
  double spread_xy() const { return n * xy - x * y; }
};

}  // namespace radioslam
