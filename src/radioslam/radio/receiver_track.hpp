// A receiver's way through a field of known anchors: its ranges cut into epochs (range_epochs.hpp), positions
// and biases per pair of antennas estimated from all of them (range_bias.hpp), a moving median at the end.
// All antennas of a receiver count as being at one point. The anchors are taken as exact.
#pragma once

#include <vector>

#include "radioslam/radio/range_bias.hpp"

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
  std::vector<PositionFix> fixes;  ///< in the order of time, one at most per stamp; z = 0 in the plane
  std::vector<RangeBias> biases;   ///< per pair of antennas
  std::size_t epochs = 0;          ///< as many as positions could have been
  double noise_factor = 1;         ///< of the ranges, over their stated sigmas; 1 at least
  double rms_m = 0;                ///< of the ranges around the positions before the median, biases removed
};

/// `anchors_m` is 2 x n or 3 x n. Ranges in the order of time, pairs numbered 0 .. pairs - 1.
ReceiverTrack track_receiver(const Eigen::MatrixXd& anchors_m, const std::vector<AnchorRange>& ranges,
                             std::size_t pairs, const ReceiverTrackParams& params = {});

}  // namespace radioslam
