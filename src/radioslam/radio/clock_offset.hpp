// How much later the trajectory's clock is than the capture's.
//
// A channel changes as fast as the antenna moves: over a step of d metres its successive values part by
// about kappa d. The offset is where how fast the channel changes and how fast the antenna moves agree best
// in time (correlation); leaving out a tenth of the time in turn says how sure it is (jackknife). Only where
// the speed changes, as at a start or a stop, is there something to agree on: a drive of constant speed
// leaves the offset open, and the sigma is then wide. kappa is not the same everywhere: where the speed
// swells and fades slowly, that alone moves the best agreement by tenths of a second, whatever part of the
// time is left out. So the agreement must be a sharp peak. Ours.
#pragma once

#include <optional>

#include "radioslam/radio/arrival_estimate.hpp"

namespace radioslam {

struct ClockOffsetParams {
  double most_s = 1;           ///< either way
  double step_s = 0.01;        ///< of the search; refined by a parabola
  double smoothing_s = 0.06;   ///< over which both speeds are taken
  double widest_s = 0.2;       ///< an estimate less sure than this is none
  double widest_peak_s = 0.2;  ///< likewise where farther to either side the two agree nearly as well
};

struct ClockOffset {
  double offset_s = 0;  ///< to be added to the capture's stamps
  double sigma_s = 0;
};

enum class NoClockOffset {
  kNotTwoWay,     ///< antennas against each other turn with the body: their speed is not the channel's
  kUncovered,     ///< too few packets that the trajectory covers, with a second to either side
  kConstantSpeed  ///< nothing to agree on: the speed hardly changes, or slowly, or the sigma is wide
};

struct ClockOffsetResult {
  std::optional<ClockOffset> clock;
  NoClockOffset reason = NoClockOffset::kUncovered;  ///< where there is none
};

/// Of a track both ways.
ClockOffsetResult estimate_clock_offset(const ChannelTrack& track, const Trajectory<SE3>& trajectory,
                                        const ClockOffsetParams& params = {});

/// The track with its stamps moved.
ChannelTrack shifted(ChannelTrack track, double offset_s);

}  // namespace radioslam
