// How much later the trajectory's clock is than the capture's: where the array is in focus.
//
// The waves in a channel add up best when the antenna's places are those of the packets' true times. The
// offset is the one with the greatest sum, over the pieces of the way, of what the strongest wave explains;
// leaving out each piece in turn says how sure it is (jackknife). A trajectory at constant velocity on a
// line is as sharp at any offset: the sigma is then as wide as the search.
#pragma once

#include <optional>

#include "radioslam/radio/arrival_estimate.hpp"

namespace radioslam {

struct ClockOffsetParams {
  double most_s = 0.3;    ///< either way
  double step_s = 0.01;   ///< of the search; refined by a parabola
};

struct ClockOffset {
  double offset_s = 0;  ///< to be added to the capture's stamps
  double sigma_s = 0;
};

/// Nothing where the track has no motion to judge by.
std::optional<ClockOffset> estimate_clock_offset(const ChannelTrack& track, const Trajectory<SE3>& trajectory,
                                                 const ArrivalParams& params,
                                                 const ClockOffsetParams& search = {});

/// The track with its stamps moved.
ChannelTrack shifted(ChannelTrack track, double offset_s);

}  // namespace radioslam
