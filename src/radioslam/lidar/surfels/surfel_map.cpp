#include "radioslam/lidar/surfels/surfel_map.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace radioslam {
namespace {

constexpr double kMinSpacings = 0.7;  // admits the points of a shifted grid of the same spacing
constexpr std::size_t kFirstSlots = 1U << 12U;

/// Squared distances along one axis from `offset` in a cell of size `cell` to the previous cell, its own, and
/// the next.
std::array<float, 3> squared_gaps(float offset, float cell) {
  return {offset * offset, 0, (cell - offset) * (cell - offset)};
}

}  // namespace

SurfelMap::SurfelMap(double spacing_m, double max_distance_m)
    : cell_m_(max_distance_m),
      cells_per_m_(static_cast<float>(1 / cell_m_)),
      least_squared_distance_(static_cast<float>(kMinSpacings * spacing_m * kMinSpacings * spacing_m)),
      keys_(kFirstSlots),
      slots_(kFirstSlots, kNoCell) {}

void SurfelMap::Cell::add(const Surfel& surfel) {
  const auto lane = static_cast<Eigen::Index>(surfels.size() % 4);
  surfels.push_back(surfel);
  if (lane == 0) {
    const Eigen::Array4f nowhere = Eigen::Array4f::Constant(std::numeric_limits<float>::infinity());
    positions.push_back({nowhere, nowhere, nowhere});
  }
  Four& last = positions.back();
  last.x(lane) = surfel.position.x();
  last.y(lane) = surfel.position.y();
  last.z(lane) = surfel.position.z();
}

std::size_t SurfelMap::slot_of(VoxelKey key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = VoxelHash{}(key)&mask;
  while (slots_[slot] != kNoCell && keys_[slot] != key) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t SurfelMap::find(const Eigen::Vector3i& cell) const { return slots_[slot_of(voxel_key(cell))]; }

void SurfelMap::rehash(std::size_t slots) {
  keys_.assign(slots, VoxelKey{});
  slots_.assign(slots, kNoCell);
  for (std::uint32_t k = 0; k < cells_.size(); ++k) {
    const VoxelKey key = voxel_key(cells_[k].index);
    const std::size_t slot = slot_of(key);
    keys_[slot] = key;
    slots_[slot] = k;
  }
}

std::uint32_t SurfelMap::find_or_make(const Eigen::Vector3i& cell, double travelled_m) {
  const VoxelKey key = voxel_key(cell);
  std::size_t slot = slot_of(key);
  if (slots_[slot] != kNoCell) return slots_[slot];
  if (2 * (cells_.size() + 1) > slots_.size()) {
    rehash(2 * slots_.size());
    slot = slot_of(key);
  }
  keys_[slot] = key;
  slots_[slot] = static_cast<std::uint32_t>(cells_.size());
  cells_.push_back({cell, travelled_m, {}, {}});
  return slots_[slot];
}

std::size_t SurfelMap::add(const std::vector<Surfel>& surfels, double travelled_m) {
  const std::size_t before = surfels_;
  for (const Surfel& surfel : surfels) {
    Cell& cell = cells_[find_or_make(voxel_of(surfel.position, cells_per_m_), travelled_m)];
    cell.seen_m = travelled_m;
    if (const Surfel* existing = nearest(surfel.position, least_squared_distance_)) {
      if (surfel.shape == SurfelShape::kSurface && existing->shape != SurfelShape::kSurface)
        adopt_surface(*existing, surfel);
      continue;
    }
    cell.add(surfel);
    ++surfels_;
  }
  return surfels_ - before;
}

void SurfelMap::adopt_surface(const Surfel& bare, const Surfel& surface) {
  for (Surfel& surfel : cells_[find(voxel_of(bare.position, cells_per_m_))].surfels)
    if (&surfel == &bare) {
      const Eigen::Vector3f position = surfel.position;
      surfel = surface;
      surfel.position = position;
    }
}

void SurfelMap::forget_before(double travelled_m) {
  const auto forgotten = std::erase_if(cells_, [&](const Cell& cell) { return cell.seen_m < travelled_m; });
  if (forgotten == 0) return;
  surfels_ = 0;
  for (const Cell& cell : cells_) surfels_ += cell.surfels.size();
  rehash(slots_.size());
}

const Surfel* SurfelMap::nearest(const Eigen::Vector3f& point, float squared_max_distance) const {
  const Eigen::Vector3i home = voxel_of(point, cells_per_m_);
  const auto cell_m = static_cast<float>(cell_m_);
  const Eigen::Vector3f offset = point - home.cast<float>() * cell_m;
  const Surfel* best = nullptr;
  float best_squared = std::min(squared_max_distance, cell_m * cell_m);
  const auto look_into = [&](const Eigen::Vector3i& index) {
    const std::uint32_t cell = find(index);
    if (cell == kNoCell) return;
    const Cell& looked = cells_[cell];
    for (std::size_t four = 0; four < looked.positions.size(); ++four) {
      const Four& at = looked.positions[four];
      const Eigen::Array4f x = at.x - point.x(), y = at.y - point.y(), z = at.z - point.z();
      const Eigen::Array4f squared = x * x + (y * y + z * z);
      if (!(squared < best_squared).any()) continue;
      for (Eigen::Index lane = 0; lane < 4; ++lane)
        if (squared(lane) < best_squared) {
          best_squared = squared(lane);
          best = &looked.surfels[4 * four + static_cast<std::size_t>(lane)];
        }
    }
  };
  look_into(home);
  const auto x_gaps = squared_gaps(offset.x(), cell_m), y_gaps = squared_gaps(offset.y(), cell_m),
             z_gaps = squared_gaps(offset.z(), cell_m);
  for (std::size_t x = 0; x < 3; ++x) {
    if (x_gaps[x] >= best_squared) continue;
    for (std::size_t y = 0; y < 3; ++y) {
      if (x_gaps[x] + y_gaps[y] >= best_squared) continue;
      for (std::size_t z = 0; z < 3; ++z) {
        const bool is_home = x == 1 && y == 1 && z == 1;
        if (is_home || x_gaps[x] + y_gaps[y] + z_gaps[z] >= best_squared) continue;
        look_into(home + Eigen::Vector3i(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)) -
                  Eigen::Vector3i::Ones());
      }
    }
  }
  return best;
}

std::vector<Surfel> SurfelMap::surfels() const {
  std::vector<Surfel> all;
  all.reserve(surfels_);
  for (const Cell& cell : cells_) all.insert(all.end(), cell.surfels.begin(), cell.surfels.end());
  return all;
}

}  // namespace radioslam
