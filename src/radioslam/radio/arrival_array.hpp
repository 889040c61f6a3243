// From a track of channels and a trajectory to the array that the motion made.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/radio/wave_grid.hpp"

namespace radioslam {

/// An array and when each of its snapshots was taken.
struct MovedArray {
  SyntheticArray array;
  std::vector<std::size_t> rows;  ///< of the track, one per snapshot
  double way_m = 0;               ///< of the antenna; of a pair, of the difference's end
  bool is_plane = true;           ///< its height hardly changes, and is left out
  bool is_difference = false;     ///< of two antennas: it knows no distance
};

/// The packets of `track` between `begin` and `end` that the trajectory covers and between which the antenna
/// moved. The channel is the track's as it stands there, the wavenumber that of one way.
MovedArray moved_array(const ChannelTrack& track, const Trajectory<SE3>& trajectory, Stamp begin, Stamp end,
                       const ArrivalParams& params);

/// Pieces of the way, each overlapping half of the next.
std::vector<SyntheticArray> subarrays(const SyntheticArray& array, double piece_m);

/// Steps over which no phase at the array's edge changes by more than two radians.
WaveGrid grid_for(const MovedArray& moved, const ArrivalParams& params, int azimuths);

/// Every third snapshot, say.
SyntheticArray thinned(const SyntheticArray& array, Eigen::Index every);

}  // namespace radioslam
