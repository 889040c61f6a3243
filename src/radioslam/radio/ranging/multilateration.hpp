// Multilateration: position of a receiver from its ranges to known anchors.
// Source: Wi-Closure 4.3.2 after Wang et al., with the signs corrected. The start solves the linear equations
// that remain after subtracting the one of the reference anchor r (the nearest),
//   2 (x_i - x_r) x + 2 (y_i - y_r) y = d_r^2 - d_i^2 - k_r + k_i,  k = |p|^2.
// Gauss-Newton then minimises (|p - p_i| - d_i) / sigma_i, with a Cauchy loss if there are redundant ranges.
// Metres. In 2D ranges are taken as horizontal.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"

namespace radioslam {

/// A range to one anchor.
struct RangeToAnchor {
  std::size_t anchor = 0;
  double range_m = 0;
  double sigma_m = 1;
};

struct MultilaterationParams {
  double loss_sigmas = 2;
  double max_sigma_m = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(loss_sigmas, "", 0.1, 1e6,
                    "scale of the Cauchy loss on ranges, in standard deviations; 2.4 is a common choice");
    RADIOSLAM_FIELD(max_sigma_m, "m", 1e-3, 1e6,
                    "largest standard deviation per axis of an accepted position");
  }
};

/// Up to three coordinates, without allocation.
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

struct Multilateration {
  SmallVector position_m;           ///< 2 or 3 coordinates
  SmallMatrix covariance;           ///< inverse information of the weighted ranges
  double sigma_m = 0;               ///< square root of the mean variance per axis
  std::vector<double> residuals_m;  ///< per range: distance to the anchor minus the range
  std::vector<double> weights;      ///< per range: weight of the robust loss, at most 1
};

/// `anchors_m` is 2 x n or 3 x n. Nothing with ranges to fewer than dimension + 1 anchors, with collinear
/// (coplanar) anchors, and for a position above `max_sigma_m`.
std::optional<Multilateration> multilaterate(const Eigen::MatrixXd& anchors_m,
                                             const std::vector<RangeToAnchor>& sights,
                                             const MultilaterationParams& params = {});

}  // namespace radioslam
