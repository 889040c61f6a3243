// Clock offset between a CSI capture and a trajectory, from the correlation of the channel's rate of change
// with the antenna's speed.
//
// A displacement of d metres changes the channel by about kappa d, so the channel changes as fast as the
// antenna moves. The offset maximises the correlation of the two rates over time; its sigma is a jackknife
// estimate over tenths of the time. The offset is observable only where the speed changes, as at starts and
// stops. As kappa varies with position, slow changes of speed can shift the maximum by tenths of a second
// whatever part of the time is left out: the peak must therefore be sharp.
#pragma once

#include <optional>

#include "radioslam/radio/aoa/aoa_estimate.hpp"

namespace radioslam {

struct ClockOffsetParams {
  double max_s = 1;                    ///< largest offset searched, of either sign
  double step_s = 0.01;                ///< of the search; refined by parabolic interpolation
  double smoothing_s = 0.06;           ///< interval over which both rates are computed
  double max_sigma_s = 0.2;            ///< largest sigma of an accepted estimate
  double max_peak_half_width_s = 0.2;  ///< largest half-width of an accepted peak
};

struct ClockOffset {
  double offset_s = 0;  ///< to add to the capture's stamps
  double sigma_s = 0;
};

enum class ClockOffsetFailure {
  kNotTwoWay,  ///< an antenna pair: its channel changes with rotation too, not with the antenna's speed alone
  kUncovered,  ///< too few packets covered by the trajectory with a margin of max_s
  kConstantSpeed  ///< unobservable: speed constant or changing slowly, or sigma too large
};

struct ClockOffsetResult {
  std::optional<ClockOffset> clock;
  ClockOffsetFailure reason = ClockOffsetFailure::kUncovered;  ///< valid where there is no estimate
};

/// Clock offset from a two-way channel track.
ClockOffsetResult estimate_clock_offset(const ChannelTrack& track, const Trajectory<SE3>& trajectory,
                                        const ClockOffsetParams& params = {});

/// The track with its stamps shifted by the offset.
ChannelTrack shifted(ChannelTrack track, double offset_s);

}  // namespace radioslam
