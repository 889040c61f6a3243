// The surroundings of a robot as surfels in the cells of a hash grid: grows scan by scan, forgets what is out
// of sight for long.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/lidar/surfel.hpp"
#include "radioslam/lidar/voxel_key.hpp"

namespace radioslam {

class SurfelMap {
 public:
  /// Holds surfels at least 0.7 `spacing_m` apart; finds them as far as `reach_m`, the size of its cells.
  SurfelMap(double spacing_m, double reach_m);

  /// Farther than this nothing is found.
  double reach_m() const { return cell_m_; }
  std::size_t size() const { return surfels_; }
  bool empty() const { return surfels_ == 0; }

  /// Adds what is not there yet, in the map's frame, seen `way_m` metres into the robot's way.
  /// What is there learns its surface from new surfels. Returns how many were added.
  std::size_t add(const std::vector<Surfel>& surfels, double way_m);

  /// Forgets the cells in which nothing was seen since `way_m` metres into the way.
  void forget_before(double way_m);

  /// The nearest surfel closer than the root of `squared_reach`, or none. The pointer is good until the map
  /// changes.
  const Surfel* nearest(const Eigen::Vector3f& point, float squared_reach) const;

  /// Every surfel, cell by cell.
  std::vector<Surfel> surfels() const;

 private:
  static constexpr std::uint32_t kNoCell = ~0U;

  std::size_t slot_of(VoxelKey key) const;
  std::uint32_t find(const Eigen::Vector3i& cell) const;
  /// The map's surfel, not known to be a surface's, lies on that of the other.
  void learn_surface(const Surfel& bare, const Surfel& surface);
  std::uint32_t find_or_make(const Eigen::Vector3i& cell, double way_m);
  void rehash(std::size_t slots);

  struct Cell {
    Eigen::Vector3i index;
    double seen_m;
    std::vector<Surfel> surfels;
  };

  double cell_m_;
  float cells_per_m_, least_squared_distance_;
  std::size_t surfels_ = 0;
  std::vector<Cell> cells_;
  std::vector<VoxelKey> keys_;
  std::vector<std::uint32_t> slots_;  ///< of open addressing: at most half of them are taken
};

}  // namespace radioslam
