// The voxels near those of one tile: all within a radius, whoever saw them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radioslam/map/voxel_map.hpp"

namespace radioslam {

class NearVoxels {
 public:
  /// Of `tiles`, all tiles of the map in their order, tile number `tile`.
  NearVoxels(const VoxelMap& map, std::span<const VoxelMap::Tile> tiles, std::size_t tile, float radius_m);

  /// Calls visit(index of the voxel, its offset from `voxel`) for each within the radius, itself included.
  template <class Visit>
  void for_each(std::size_t voxel, const Visit& visit) const {
    const Eigen::Vector3f at = relative(voxel);
    const std::array<int, 3> middle = cell_of(at);
    for (int y = middle[1] - 1; y <= middle[1] + 1; ++y)
      for (int x = middle[0] - 1; x <= middle[0] + 1; ++x)
        for (int z = middle[2] - 1; z <= middle[2] + 1; ++z) {
          const std::size_t bin = bin_of({x, y, z});
          for (std::uint32_t k = begin_[bin]; k < begin_[bin + 1]; ++k) {
            const Eigen::Vector3f offset = near_[k].position - at;
            if (offset.squaredNorm() <= radius_m_ * radius_m_) visit(near_[k].voxel, offset);
          }
        }
  }

 private:
  struct Near {
    std::uint32_t voxel = 0;
    Eigen::Vector3f position;  ///< relative to the tile's corner
  };

  Eigen::Vector3f relative(std::size_t voxel) const;
  std::array<int, 3> cell_of(const Eigen::Vector3f& at) const;
  std::size_t bin_of(const std::array<int, 3>& cell) const;

  const VoxelMap& map_;
  float radius_m_;
  Eigen::Vector3d corner_m_;
  int cells_ = 0;                     ///< along x and y, with a margin on both sides
  std::vector<Near> near_;            ///< by bin
  std::vector<std::uint32_t> begin_;  ///< of each bin, then the end
};

}  // namespace radioslam
