// How much too long a pair of antennas measures, constantly: cables, clocks and antennas differ by
// decimetres.
//
// With known geometry a pair's bias is the robust mean of measured less true distance. Without, where anchors
// are known and the receiver is not, biases and positions are estimated together: each epoch with more ranges
// than coordinates says something about the biases, whatever the position. With positions eliminated,
//   H = sum over epochs of W - W J (J^T W J)^-1 J^T W  + I / sigma_b^2,   H db = sum of P r - b / sigma_b^2,
// W being 1/sigma^2 times the weight of a Cauchy loss, all of it less where neighbours in time err alike.
// Ranges whose error changes with the place (reflections) are no constant bias: it comes out wrong, and so
// may the positions. The prior sigma_b keeps what is not observed near zero. Metres; measured = true + bias.
// Cost: O(ranges) per iteration plus (pairs)^3.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/range_epochs.hpp"

namespace radioslam {

struct RangeBiasParams {
  double prior_sigma_m = 0.5;  ///< of a bias before anything is measured
  int most_iterations = 30;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"prior_sigma_m", "m", 0, 100,
                "how large a bias may be; 0 keeps all at zero. UWB shows 0.2-0.5 m"},
          self.prior_sigma_m);
    visit(Field{"most_iterations", "", 0, 1000, "of biases and positions in turn"}, self.most_iterations);
  }
};

struct RangeBias {
  double bias_m = 0;
  double sigma_m = 0;     ///< of the bias
  double spread_m = 0;    ///< of single ranges around it, robustly
  std::size_t count = 0;  ///< ranges it rests on
};

/// A measured range whose true distance is known.
struct KnownRange {
  std::size_t pair = 0;
  double range_m = 0, distance_m = 0;
};

/// Per pair 0 .. pairs - 1, by Huber's mean around the median with the scale of the median deviation.
std::vector<RangeBias> biases_of_known(const std::vector<KnownRange>& ranges, std::size_t pairs);

/// Positions and biases from the same ranges.
struct CalibratedPositions {
  std::vector<std::optional<Multilateration>> epochs;  ///< with the biases removed; none where not to be had
  std::vector<RangeBias> biases;                       ///< per pair
  double noise_factor = 1;  ///< of the ranges, over their stated sigmas; 1 at least
};

/// `anchors_m` is 2 x n or 3 x n; pairs are numbered 0 .. pairs - 1.
CalibratedPositions calibrate_positions(const Eigen::MatrixXd& anchors_m,
                                        const std::vector<RangeEpoch>& epochs, std::size_t pairs,
                                        const MultilaterationParams& multilateration = {},
                                        const RangeBiasParams& params = {});

}  // namespace radioslam
