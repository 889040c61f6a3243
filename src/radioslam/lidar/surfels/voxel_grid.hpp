// Voxel downsampling: the mean of the points in every cell of a regular grid, or the first surfel in it.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

// Integer key of the regular-grid cell that contains a point.

/// 21 bits per axis: unique within a million cells of the origin, farther cells may collide.
struct VoxelKey {
  std::uint64_t value = 0;
  bool operator==(const VoxelKey&) const = default;
};

inline VoxelKey voxel_key(const Eigen::Vector3i& cell) {
  constexpr std::uint64_t kMask = (1U << 21U) - 1U;
  const auto bits = [](int index) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(index)) & kMask;
  };
  return {bits(cell.x()) << 42U | bits(cell.y()) << 21U | bits(cell.z())};
}

inline Eigen::Vector3i voxel_of(const Eigen::Vector3f& point, float cells_per_m) {
  return (point * cells_per_m).array().floor().cast<int>();
}

/// Finaliser of splitmix64: spreads neighbouring cells over all 64 bits.
struct VoxelHash {
  std::size_t operator()(VoxelKey key) const {
    std::uint64_t x = key.value;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
  }
};

/// Means in the order of each cell's first point. Cost: one hash access per point.
std::vector<Eigen::Vector3f> voxel_downsample(const std::vector<Eigen::Vector3f>& points, double cell_m);

/// Mean points with their mean times; no times if the input has none.
struct DownsampledPoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> times_s;
};
DownsampledPoints voxel_downsample(const std::vector<Eigen::Vector3f>& points,
                                   const std::vector<float>& times_s, double cell_m);

/// The first surfel in every cell, in input order.
std::vector<Surfel> voxel_first(const std::vector<Surfel>& surfels, double cell_m);

}  // namespace radioslam
