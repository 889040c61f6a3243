#include "radioslam/map/voxel_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace radioslam {
namespace {

constexpr std::uint32_t kEmpty = 0xffffffff;
constexpr unsigned kAxisBits = 18;
constexpr std::int32_t kHalf = 1 << (kAxisBits - 1);
constexpr std::uint64_t kAxisMask = (std::uint64_t{1} << kAxisBits) - 1;
constexpr double kOffsetSteps = 65536;
constexpr std::uint16_t kMaxCount = 65535;
constexpr float kDirectionSteps = 127;
constexpr std::size_t kFirstPlaces = 1 << 16;

std::size_t hash_of(std::uint64_t key) {
  key ^= key >> 31U;
  key *= 0x9e3779b97f4a7c15U;
  return static_cast<std::size_t>(key ^ (key >> 29U));
}

std::uint16_t offset_of(double in_voxel) {
  return static_cast<std::uint16_t>(std::clamp(in_voxel * kOffsetSteps, 0.0, kOffsetSteps - 1));
}

double in_voxel(std::uint16_t offset) { return (offset + 0.5) / kOffsetSteps; }

std::uint16_t sum_of_counts(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(kMaxCount, std::uint32_t{a} + b));
}

std::array<std::int8_t, 3> stored(const Eigen::Vector3f& direction) {
  std::array<std::int8_t, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    result[axis] = static_cast<std::int8_t>(std::lround(kDirectionSteps * direction[static_cast<int>(axis)]));
  return result;
}

void join(Voxel& a, const Voxel& b) {
  const double share = b.returns / (static_cast<double>(a.returns) + b.returns);
  for (std::size_t axis = 0; axis < 3; ++axis)
    a.offset[axis] = offset_of((1 - share) * in_voxel(a.offset[axis]) + share * in_voxel(b.offset[axis]));
  a.intensity += static_cast<float>(share) * (b.intensity - a.intensity);
  a.time_ms = std::min(a.time_ms, b.time_ms);
  a.returns = sum_of_counts(a.returns, b.returns);
}

}  // namespace

VoxelMap::VoxelMap(double voxel_m, std::size_t max_points)
    : voxel_m_(voxel_m), max_points_(max_points), index_(kFirstPlaces, kEmpty) {}

std::optional<std::uint64_t> VoxelMap::key_of(const Cell& cell, std::uint16_t robot) {
  std::uint64_t key = robot;
  for (const int axis : {1, 0, 2}) {
    const std::int32_t value = cell[static_cast<std::size_t>(axis)] + kHalf;
    if (value < 0 || value >= 2 * kHalf) return std::nullopt;
    key = (key << kAxisBits) | static_cast<std::uint64_t>(value);
  }
  return key;
}

VoxelMap::Cell VoxelMap::cell_of(std::uint64_t key) {
  const auto axis = [&](unsigned shift) {
    return static_cast<std::int32_t>((key >> shift) & kAxisMask) - kHalf;
  };
  return {axis(kAxisBits), axis(2 * kAxisBits), axis(0)};
}

std::size_t VoxelMap::place_of(std::uint64_t key) const {
  const std::size_t mask = index_.size() - 1;
  std::size_t place = hash_of(key) & mask;
  while (index_[place] != kEmpty && voxels_[index_[place]].key != key) place = (place + 1) & mask;
  return place;
}

void VoxelMap::grow_index(std::size_t places) {
  index_.assign(places, kEmpty);
  for (std::size_t k = 0; k < voxels_.size(); ++k)
    index_[place_of(voxels_[k].key)] = static_cast<std::uint32_t>(k);
}

std::optional<std::uint64_t> VoxelMap::key_of(const MapReturn& of) const {
  const Eigen::Vector3d at = of.position / voxel_m_;
  if (!(at.cwiseAbs().maxCoeff() < kHalf)) return std::nullopt;
  Cell cell{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    cell[axis] = static_cast<std::int32_t>(std::floor(at[static_cast<int>(axis)]));
  return key_of(cell, of.robot);
}

/// Has the memory read that add() will need in a moment: nearly all of its time would be waiting for that.
void VoxelMap::fetch_index(const MapReturn& of) const {
  if (const auto key = key_of(of)) __builtin_prefetch(&index_[hash_of(*key) & (index_.size() - 1)]);
}

void VoxelMap::fetch_voxel(const MapReturn& of) const {
  const auto key = key_of(of);
  if (!key) return;
  const std::uint32_t k = index_[hash_of(*key) & (index_.size() - 1)];
  if (k != kEmpty) __builtin_prefetch(&voxels_[k]);
}

void VoxelMap::add(std::span<const MapReturn> returns) {
  constexpr std::size_t kAhead = 8;
  for (std::size_t k = 0; k < returns.size(); ++k) {
    if (k + 2 * kAhead < returns.size()) fetch_index(returns[k + 2 * kAhead]);
    if (k + kAhead < returns.size()) fetch_voxel(returns[k + kAhead]);
    add(returns[k]);
  }
}

void VoxelMap::add(const MapReturn& of) {
  const auto key = key_of(of);
  if (!key) {
    ++beyond_;
    return;
  }
  const std::size_t place = place_of(*key);
  std::size_t k = index_[place];
  if (k == kEmpty) {
    if (voxels_.size() == max_points_) {
      double_voxels();
      return add(of);
    }
    k = voxels_.size();
    index_[place] = static_cast<std::uint32_t>(k);
    voxels_.push_back({*key, 0, of.time_ms});
    if (2 * voxels_.size() > index_.size()) grow_index(2 * index_.size());
  }
  Voxel& voxel = voxels_[k];
  voxel.returns = sum_of_counts(voxel.returns, 1);
  const std::array<std::int8_t, 3> direction = stored(of.to_scanner);
  if (voxel.returns == 1 || std::abs(direction[2]) > std::abs(voxel.direction[2]))
    voxel.direction = direction;
  voxel.time_ms = std::min(voxel.time_ms, of.time_ms);
  voxel.intensity += (of.intensity - voxel.intensity) / voxel.returns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = of.position[static_cast<int>(axis)] / voxel_m_, offset = at - std::floor(at);
    const double mean = voxel.returns == 1 ? offset : in_voxel(voxel.offset[axis]);
    voxel.offset[axis] = offset_of(mean + (offset - mean) / voxel.returns);
  }
}

/// Joins what lies in a voxel of twice the size; the order of the voxels is that of their first.
void VoxelMap::double_voxels() {
  voxel_m_ *= 2;
  index_.assign(index_.size(), kEmpty);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < voxels_.size(); ++k) {
    Voxel voxel = voxels_[k];
    Cell cell = cell_of(voxel.key);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t half = cell[axis] >> 1;
      voxel.offset[axis] = offset_of((cell[axis] - 2 * half + in_voxel(voxel.offset[axis])) / 2);
      cell[axis] = half;
    }
    voxel.key = *key_of(cell, robot_of(voxel));
    const std::size_t place = place_of(voxel.key);  // among the first `kept`, which are done
    if (index_[place] == kEmpty) {
      index_[place] = static_cast<std::uint32_t>(kept);
      voxels_[kept++] = voxel;
    } else {
      join(voxels_[index_[place]], voxel);
    }
  }
  voxels_.resize(kept);
}

std::vector<VoxelMap::Tile> VoxelMap::sort_into_tiles(double tile_m) {
  index_ = {};
  const double voxels = std::clamp(tile_m / voxel_m_, 1.0, static_cast<double>(kHalf));
  tile_voxels_ = static_cast<std::int32_t>(std::bit_ceil(static_cast<std::uint32_t>(voxels)));
  const auto shift = static_cast<unsigned>(std::countr_zero(static_cast<std::uint32_t>(tile_voxels_)));
  const auto tile_of = [&](std::uint64_t key) {
    const std::uint64_t y = ((key >> (2 * kAxisBits)) & kAxisMask) >> shift;
    return (y << kAxisBits) | (((key >> kAxisBits) & kAxisMask) >> shift);
  };
  std::sort(voxels_.begin(), voxels_.end(), [&](const Voxel& a, const Voxel& b) {
    const std::uint64_t tile_a = tile_of(a.key), tile_b = tile_of(b.key);
    return tile_a != tile_b ? tile_a < tile_b : a.key < b.key;
  });
  std::vector<Tile> tiles;
  for (std::size_t k = 0; k < voxels_.size(); ++k) {
    if (k == 0 || tile_of(voxels_[k - 1].key) != tile_of(voxels_[k].key)) {
      const Cell cell = cell_of(voxels_[k].key);
      tiles.push_back({cell[0] >> shift, cell[1] >> shift, k, k});
    }
    tiles.back().end = k + 1;
  }
  return tiles;
}

Eigen::Vector3d VoxelMap::position(const Voxel& voxel) const {
  const Cell cell = cell_of(voxel.key);
  Eigen::Vector3d at;
  for (std::size_t axis = 0; axis < 3; ++axis)
    at[static_cast<int>(axis)] = voxel_m_ * (cell[axis] + in_voxel(voxel.offset[axis]));
  return at;
}

}  // namespace radioslam
