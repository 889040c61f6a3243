// Range epochs: groups a receiver's ranges to anchors into epochs of one position each, and smooths positions
// over time by a moving median.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/mission/radio_links.hpp"
#include "radioslam/radio/ranging/multilateration.hpp"

namespace radioslam {

/// A range of one receiver to one anchor. `pair` numbers its pair of antennas among all.
struct AnchorRange {
  Stamp stamp;
  std::size_t pair = 0;
  RangeToAnchor sight;
};

struct RangeEpoch {
  Stamp stamp;  ///< mean of its ranges' stamps
  std::vector<AnchorRange> ranges;
};

struct RangeEpochParams {
  double epoch_s = 0.2;
  int median_samples = 10;
  double max_gap_s = 2;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        epoch_s, "s", 0, 60,
        "duration within which ranges share one position; default: one cycle of five radios at 25 Hz");
    RADIOSLAM_FIELD(median_samples, "", 1, 1000,
                    "number of positions in the moving median; 10 in Wi-Closure");
    RADIOSLAM_FIELD(max_gap_s, "s", 0, 1e6,
                    "largest time gap between successive positions within the moving median");
  }
};

/// Epochs of one receiver's ranges, given in time order. An epoch ends after epoch_s or where a pair of
/// antennas occurs a second time.
std::vector<RangeEpoch> range_epochs(const std::vector<AnchorRange>& ranges,
                                     const RangeEpochParams& params = {});

/// Median per axis over a window around each position. For an even number n it is the mean of the medians
/// over k - n/2 .. k + n/2 - 1 and k - n/2 + 1 .. k + n/2, so that steady motion is not delayed. Windows
/// shrink symmetrically at the ends and at gaps. `fixes` must be in time order; sigmas are unchanged.
std::vector<PositionFix> moving_median(const std::vector<PositionFix>& fixes,
                                       const RangeEpochParams& params = {});

}  // namespace radioslam
