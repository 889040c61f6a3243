// Surfel map on a hash grid: insertion, nearest-neighbour search, removal of what has long been out of sight.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/lidar/surfels/surfel.hpp"
#include "radioslam/lidar/surfels/voxel_grid.hpp"

namespace radioslam {

class SurfelMap {
 public:
  /// Keeps surfels at least 0.7 `spacing_m` apart; searches up to `max_distance_m`, which is also the cell
  /// size.
  SurfelMap(double spacing_m, double max_distance_m);

  /// Largest search distance.
  double max_distance_m() const { return cell_m_; }
  std::size_t size() const { return surfels_; }
  bool empty() const { return surfels_ == 0; }

  /// Adds new surfels, given in the map's frame and seen after a travelled distance of `travelled_m`;
  /// existing ones without a surface take over that of a new planar one. Returns the number added.
  std::size_t add(const std::vector<Surfel>& surfels, double travelled_m);

  /// Removes the cells last seen before the travelled distance `travelled_m`.
  void forget_before(double travelled_m);

  /// The nearest surfel closer than the root of `squared_max_distance`, or null. The pointer is valid until
  /// the map changes.
  const Surfel* nearest(const Eigen::Vector3f& point, float squared_max_distance) const;

  /// All surfels, cell by cell.
  std::vector<Surfel> surfels() const;

 private:
  static constexpr std::uint32_t kNoCell = ~0U;

  std::size_t slot_of(VoxelKey key) const;
  std::uint32_t find(const Eigen::Vector3i& cell) const;
  /// Gives the map's surfel `bare` the surface of `surface`.
  void adopt_surface(const Surfel& bare, const Surfel& surface);
  std::uint32_t find_or_make(const Eigen::Vector3i& cell, double travelled_m);
  void rehash(std::size_t slots);

  /// Positions of four surfels, infinite where there are fewer: distances are computed four at a time.
  struct Four {
    Eigen::Array4f x, y, z;
  };
  struct Cell {
    Eigen::Vector3i index;
    double seen_m;
    std::vector<Surfel> surfels;
    std::vector<Four> positions;  ///< of the surfels

    void add(const Surfel& surfel);
  };

  double cell_m_;
  float cells_per_m_, least_squared_distance_;
  std::size_t surfels_ = 0;
  std::vector<Cell> cells_;
  std::vector<VoxelKey> keys_;
  std::vector<std::uint32_t> slots_;  ///< open addressing, at most half occupied
};

}  // namespace radioslam
