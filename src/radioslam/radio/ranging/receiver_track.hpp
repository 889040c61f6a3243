// Trajectory of a receiver from its ranges to known anchors: epochs (range_epochs.hpp), joint estimation of
// positions and range biases (range_bias.hpp), and a moving median. All antennas of a receiver are assumed at
// one point; the anchors are assumed exact.
#pragma once

#include <vector>

#include "radioslam/radio/ranging/range_bias.hpp"

namespace radioslam {

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
