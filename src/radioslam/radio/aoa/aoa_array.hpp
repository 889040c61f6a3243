// Synthetic array: antenna positions and channels of the packets in a window, from a channel track and a
// trajectory, and the grid of sources that the array's extent calls for.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/radio/aoa/aoa_types.hpp"
#include "radioslam/radio/aoa/synthetic_array.hpp"

namespace radioslam {

/// Grid of wave sources over which profiles are computed: azimuth x elevation x wavefront curvature.
struct WaveGrid {
  int azimuths = 360;  ///< evenly spaced, from -pi
  std::vector<double> elevations_rad{0};
  std::vector<double> curvatures_per_m{0};

  double azimuth_rad(int k) const { return -std::numbers::pi + 2 * std::numbers::pi * k / azimuths; }
  std::size_t size() const {
    return static_cast<std::size_t>(azimuths) * elevations_rad.size() * curvatures_per_m.size();
  }
  /// Index order is elevation, curvature, azimuth; azimuth varies fastest.
  WaveSource source(std::size_t index) const {
    const auto around = static_cast<std::size_t>(azimuths);
    const std::size_t row = index / around;
    return {azimuth_rad(static_cast<int>(index % around)), elevations_rad[row / curvatures_per_m.size()],
            curvatures_per_m[row % curvatures_per_m.size()]};
  }
};

/// Which directions an array resolves, by the phase differences over its extent along each axis: an axis with
/// less than a fraction of a radian is dominated by the trajectory's errors.
enum class ArrayShape {
  kLine,   ///< straight and not steep: a cone of directions about it is ambiguous; sources are taken as level
  kPlane,  ///< level: up and down are ambiguous
  kSpace
};

/// An array and the packet of each of its snapshots.
struct MovedArray {
  SyntheticArray array;
  std::vector<std::size_t> rows;  ///< of the channel track, one per snapshot
  double way_m = 0;               ///< path length of the antenna; for a pair, of the tip of its baseline
  double extent_m = 0;            ///< diagonal of its bounding box
  ArrayShape shape = ArrayShape::kPlane;
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();   ///< principal axis of largest extent
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< principal axis of smallest extent
  bool is_difference = false;                         ///< antenna pair: distances are unobservable
};

/// Array of the packets of `track` between `begin` and `end` that the trajectory covers and between which the
/// antenna moved. The channel is copied from the track; the wavenumber is the one-way wavenumber.
MovedArray moved_array(const ChannelTrack& track, const Trajectory<SE3>& trajectory, Stamp begin, Stamp end,
                       const AoaParams& params);

/// Subarrays of about `subarray_m` along the antenna's path, each overlapping the next by half.
std::vector<SyntheticArray> subarrays(const SyntheticArray& array, double subarray_m);

/// Grid on which no phase at the edge of a subarray of `params.subarray_m` changes by more than two radians
/// from one elevation to the next, or by more than one from one curvature to the next.
WaveGrid grid_for(const MovedArray& moved, const AoaParams& params, int azimuths);

/// The same for the whole aperture as one coherent array, without elevations that its height cannot resolve.
WaveGrid full_aperture_grid(const MovedArray& moved, const AoaParams& params, int azimuths);

/// Means of successive snapshots over displacements so short that no wave's phase changes by more than 0.8
/// rad: fewer snapshots at no loss of resolution.
SyntheticArray averaged(const SyntheticArray& array);

}  // namespace radioslam
