// Where a receiver is, from its ranges to known anchors (Wi-Closure 4.3.2 after Wang et al., signs
// corrected). Start: the reference anchor r (the nearest) is subtracted from the others' equations,
//   2 (x_i - x_r) x + 2 (y_i - y_r) y = d_r^2 - d_i^2 - k_r + k_i,  k = |p|^2,
// which is linear. Then Gauss-Newton on |p - p_i| - d_i over sigma_i, with a Cauchy loss where more ranges
// are there than needed. Metres. In the plane z stays 0 and ranges are taken as horizontal.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"

namespace radioslam {

/// A range to one anchor.
struct AnchorSight {
  std::size_t anchor = 0;
  double range_m = 0;
  double sigma_m = 1;
};

struct MultilaterationParams {
  double loss_sigmas = 2;      ///< scale of the Cauchy loss
  double largest_sigma_m = 5;  ///< a position less certain than this is none

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"loss_sigmas", "", 0.1, 1e6, "scale of the Cauchy loss on ranges; 2.4 is usual, ours"},
          self.loss_sigmas);
    visit(Field{"largest_sigma_m", "m", 1e-3, 1e6, "positions less certain than this are left out; ours"},
          self.largest_sigma_m);
  }
};

/// Up to three coordinates, without allocation.
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

struct Multilateration {
  SmallVector position_m;           ///< 2 or 3 coordinates
  SmallMatrix covariance;           ///< from the weighted ranges
  double sigma_m = 0;               ///< root of the mean variance per axis
  std::vector<double> residuals_m;  ///< per range: distance to the anchor less the range
  std::vector<double> weights;      ///< per range, of its loss: 1 is full
};

/// `anchors_m` is 2 x n or 3 x n. Nothing for fewer ranges to different anchors than dimensions + 1, for
/// anchors on one line (plane), and for a position too uncertain.
std::optional<Multilateration> multilaterate(const Eigen::MatrixXd& anchors_m,
                                             const std::vector<AnchorSight>& sights,
                                             const MultilaterationParams& params = {});

}  // namespace radioslam
