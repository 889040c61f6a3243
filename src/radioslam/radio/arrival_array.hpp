// From a track of channels and a trajectory to the array that the motion made.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/radio/wave_grid.hpp"

namespace radioslam {

/// Which directions an array tells apart, judged by the phases that its extent is worth: what turns no phase
/// by more than a fraction of a radian is told by the trajectory's errors and not by the wave.
enum class ArrayShape {
  kLine,   ///< straight and more level than steep: a cone of directions about it is one; taken as level
  kPlane,  ///< level: up and down are one
  kSpace
};

/// An array and when each of its snapshots was taken.
struct MovedArray {
  SyntheticArray array;
  std::vector<std::size_t> rows;  ///< of the track, one per snapshot
  double way_m = 0;               ///< of the antenna; of a pair, of the difference's end
  double extent_m = 0;            ///< from one end of its bounding box to the other
  ArrayShape shape = ArrayShape::kPlane;
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();   ///< where it reaches furthest
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< where it reaches least
  bool is_difference = false;                         ///< of two antennas: it knows no distance
};

/// The packets of `track` between `begin` and `end` that the trajectory covers and between which the antenna
/// moved. The channel is the track's as it stands there, the wavenumber that of one way.
MovedArray moved_array(const ChannelTrack& track, const Trajectory<SE3>& trajectory, Stamp begin, Stamp end,
                       const ArrivalParams& params);

/// Pieces of the way, each overlapping half of the next.
std::vector<SyntheticArray> subarrays(const SyntheticArray& array, double piece_m);

/// Steps over which no phase at the edge of a piece of `params.subarray_m` changes by more than two radians,
/// over bends one.
WaveGrid grid_for(const MovedArray& moved, const ArrivalParams& params, int azimuths);

/// Likewise of the whole way, without the raised directions that its height alone does not tell.
WaveGrid whole_way_grid(const MovedArray& moved, const ArrivalParams& params, int azimuths);

/// Means of successive snapshots over steps so short that no wave turns by more than 0.8 rad: what is
/// sampled more finely than that is as good, and quicker.
SyntheticArray averaged(const SyntheticArray& array);

}  // namespace radioslam
