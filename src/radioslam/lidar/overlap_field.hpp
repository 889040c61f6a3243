// How well a thinned scan overlaps a coarse map at many poses: a look-up per point instead of a search.
//
//   score(T) = mean over k of f(d(T p_k)),  f(d) = 1 / (1 + 16 d^2 / D^2), 0 from d = D on
//   d: distance to the nearest surfel of the map, both at the centres of voxels of D / 8
//   D: the map's largest search distance
// A point within D / 4 counts at least one half, at the full distance next to nothing. d^2 in voxels is an
// integer of at most 64: it is the smallest over a window along each axis in turn, of bytes. Where the map
// would need too many voxels, D is doubled.
//
// Scores do not depend on the order of the points: they are sums of integers.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

class OverlapField {
 public:
  OverlapField(const std::vector<Surfel>& surfels, double max_distance_m);

  /// Of the points turned and then shifted to each of the `places`; 0 to 1.
  std::vector<double> scores(const std::vector<Surfel>& points, const Eigen::Quaterniond& turn,
                             const std::vector<Eigen::Vector3d>& places) const;

  std::size_t bytes() const { return values_.size(); }

 private:
  Eigen::Vector3i voxel_of(const Eigen::Vector3f& point) const;
  std::size_t offset_of(const Eigen::Vector3i& voxel) const;
  /// The smallest of every voxel's values and those up to D away along an axis, which add their squared
  /// distance.
  void spread(std::size_t count, std::size_t stride);

  float voxels_per_m_;
  Eigen::Vector3i corner_ = Eigen::Vector3i::Zero(), size_ = Eigen::Vector3i::Zero();
  std::vector<std::uint8_t> values_;  ///< 255 f; x slowest
};

}  // namespace radioslam
