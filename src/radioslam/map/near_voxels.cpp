#include "radioslam/map/near_voxels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace radioslam {
namespace {

constexpr int kLayers = 64;  // of heights; higher ones share the bins of lower ones
constexpr int kMargin = 2;   // cells on either side of a tile

}  // namespace

NearVoxels::NearVoxels(const VoxelMap& map, std::span<const VoxelMap::Tile> tiles, std::size_t tile,
                       float radius_m)
    : map_(map),
      radius_m_(radius_m),
      corner_m_(map.tile_width_m() * tiles[tile].x, map.tile_width_m() * tiles[tile].y, 0),
      cells_(static_cast<int>(std::ceil(map.tile_width_m() / static_cast<double>(radius_m))) + 2 * kMargin) {
  std::vector<Near> found;
  std::vector<std::uint32_t> bins;
  begin_.assign(static_cast<std::size_t>(cells_ * cells_ * kLayers) + 1, 0);
  const auto first = [&](std::int32_t y, std::int32_t x) {
    return std::partition_point(tiles.begin(), tiles.end(), [&](const VoxelMap::Tile& t) {
      return std::pair(t.y, t.x) < std::pair(y, x);
    });
  };
  for (std::int32_t y = tiles[tile].y - 1; y <= tiles[tile].y + 1; ++y)
    for (auto next = first(y, tiles[tile].x - 1);
         next != tiles.end() && next->y == y && next->x <= tiles[tile].x + 1; ++next)
      for (std::size_t k = next->begin; k < next->end; ++k) {
        const Eigen::Vector3f at = relative(k);
        const std::array<int, 3> cell = cell_of(at);
        if (std::min(cell[0], cell[1]) < 0 || std::max(cell[0], cell[1]) >= cells_) continue;
        found.push_back({static_cast<std::uint32_t>(k), at});
        bins.push_back(static_cast<std::uint32_t>(bin_of(cell)));
        ++begin_[bins.back() + 1];
      }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  near_.resize(found.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t k = 0; k < found.size(); ++k) near_[next[bins[k]]++] = found[k];
}

Eigen::Vector3f NearVoxels::relative(std::size_t voxel) const {
  return (map_.position(map_.voxels()[voxel]) - corner_m_).cast<float>();
}

std::array<int, 3> NearVoxels::cell_of(const Eigen::Vector3f& at) const {
  const auto cell = [&](float coordinate) { return static_cast<int>(std::floor(coordinate / radius_m_)); };
  return {cell(at.x()) + kMargin, cell(at.y()) + kMargin, cell(at.z())};
}

std::size_t NearVoxels::bin_of(const std::array<int, 3>& cell) const {
  return static_cast<std::size_t>((cell[1] * cells_ + cell[0]) * kLayers + (cell[2] & (kLayers - 1)));
}

}  // namespace radioslam
