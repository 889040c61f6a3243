// A receiver's ranges to anchors as they came, cut into epochs that share one position; and positions over
// time made smooth by a moving median.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/mission/radio_links.hpp"
#include "radioslam/radio/multilateration.hpp"

namespace radioslam {

/// A range of one receiver to one anchor. `pair` numbers its pair of antennas among all.
struct AnchorRange {
  Stamp stamp;
  std::size_t pair = 0;
  AnchorSight sight;
};

struct RangeEpoch {
  Stamp stamp;  ///< mean of its ranges'
  std::vector<AnchorRange> ranges;
};

struct RangeEpochParams {
  double epoch_s = 0.2;      ///< ranges within so much time share a position
  int median_samples = 10;   ///< positions under the moving median
  double largest_gap_s = 2;  ///< between neighbours under the median

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"epoch_s", "s", 0, 60,
                "ranges within so much time share a position; a turn of five radios at 25 Hz"},
          self.epoch_s);
    visit(Field{"median_samples", "", 1, 1000, "positions under the moving median; Wi-Closure"},
          self.median_samples);
    visit(Field{"largest_gap_s", "s", 0, 1e6, "the median does not reach across longer gaps; ours"},
          self.largest_gap_s);
  }
};

/// Ranges of ONE receiver in the order of time. An epoch ends after epoch_s, and where a pair of antennas
/// comes a second time.
std::vector<RangeEpoch> range_epochs(const std::vector<AnchorRange>& ranges,
                                     const RangeEpochParams& params = {});

/// Per axis the median of the positions around each one: for an even number n the mean of the medians from
/// k - n/2 to k + n/2 - 1 and from k - n/2 + 1 to k + n/2, so that steady motion is not delayed. Windows
/// shrink on both sides alike at the ends and at gaps. In the order of time; sigmas stay as they are.
std::vector<PositionFix> moving_median(const std::vector<PositionFix>& fixes,
                                       const RangeEpochParams& params = {});

}  // namespace radioslam
