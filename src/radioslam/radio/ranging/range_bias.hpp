// Range biases: constant range error per pair of antennas, from cables, clocks and antennas (decimetres).
//
// With known anchors and an unknown receiver, biases and positions are estimated jointly: each epoch with
// more ranges than coordinates constrains the biases. With positions eliminated,
//   H = sum over epochs of W - W J (J^T W J)^-1 J^T W  + I / sigma_b^2,   H db = sum of P r - b / sigma_b^2,
// W being 1/sigma^2 times the weight of a Cauchy loss, reduced where successive residuals are correlated.
// Errors that change with position (reflections) are not constant biases; they bias the estimate and possibly
// the positions. The prior sigma_b keeps unobservable biases near zero. Metres; measured = true + bias. Cost:
// O(ranges) per iteration plus (pairs)^3.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/ranging/range_epochs.hpp"

namespace radioslam {

struct RangeBiasParams {
  double prior_sigma_m = 0.5;
  int max_iterations = 30;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        prior_sigma_m, "m", 0, 100,
        "prior standard deviation of a range bias; 0 holds all biases at zero; UWB radios show 0.2-0.5 m");
    RADIOSLAM_FIELD(max_iterations, "", 0, 1000,
                    "largest number of alternations between biases and positions");
  }
};

struct RangeBias {
  double bias_m = 0;
  double sigma_m = 0;     ///< of the bias
  double spread_m = 0;    ///< robust standard deviation of single ranges around it
  std::size_t count = 0;  ///< ranges used
};

/// Positions and biases estimated jointly.
struct CalibratedPositions {
  std::vector<std::optional<Multilateration>> epochs;  ///< positions, with the biases removed
  std::vector<RangeBias> biases;                       ///< per pair
  double noise_factor = 1;  ///< noise of the ranges relative to their stated sigmas; at least 1
};

/// `anchors_m` is 2 x n or 3 x n; pairs are numbered 0 .. pairs - 1.
CalibratedPositions calibrate_positions(const Eigen::MatrixXd& anchors_m,
                                        const std::vector<RangeEpoch>& epochs, std::size_t pairs,
                                        const MultilaterationParams& multilateration = {},
                                        const RangeBiasParams& params = {});

/// Trajectory of a receiver from its ranges to known anchors: epochs (range_epochs.hpp), joint estimation of
/// positions and range biases (range_bias.hpp), and a moving median. All antennas of a receiver are assumed
/// at one point; the anchors are assumed exact.
struct ReceiverTrackParams {
  RangeEpochParams epochs;
  MultilaterationParams position;
  RangeBiasParams bias;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("epochs", self.epochs);
    visit("position", self.position);
    visit("bias", self.bias);
  }
};

struct ReceiverTrack {
  std::vector<PositionFix> fixes;  ///< in time order, at most one per stamp; z = 0 in 2D
  std::vector<RangeBias> biases;   ///< per pair of antennas
  std::size_t epochs = 0;          ///< number of epochs, with or without a position
  double noise_factor = 1;         ///< noise of the ranges relative to their stated sigmas; at least 1
  double rms_m = 0;                ///< of the ranges, before the median, biases removed
};

/// `anchors_m` is 2 x n or 3 x n. Ranges must be in time order, with pairs numbered 0 .. pairs - 1.
ReceiverTrack track_receiver(const Eigen::MatrixXd& anchors_m, const std::vector<AnchorRange>& ranges,
                             std::size_t pairs, const ReceiverTrackParams& params = {});

}  // namespace radioslam
