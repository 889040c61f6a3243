#include "radioslam/lidar/surfels/voxel_grid.hpp"

#include <bit>
#include <cstddef>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

/// Cell numbers by key; open addressing, at most half of the slots occupied.
class CellNumbers {
 public:
  explicit CellNumbers(std::size_t max_cells)
      : mask_(std::bit_ceil(2 * max_cells + 2) - 1), keys_(mask_ + 1), numbers_(mask_ + 1, kFree) {}

  /// The number of `key`; assigns it `next` on first use.
  std::uint32_t number_of(VoxelKey key, std::uint32_t next) {
    std::size_t slot = VoxelHash{}(key)&mask_;
    while (numbers_[slot] != kFree && keys_[slot] != key) slot = (slot + 1) & mask_;
    if (numbers_[slot] == kFree) {
      keys_[slot] = key;
      numbers_[slot] = next;
    }
    return numbers_[slot];
  }

 private:
  static constexpr std::uint32_t kFree = ~0U;
  std::size_t mask_;
  std::vector<VoxelKey> keys_;
  std::vector<std::uint32_t> numbers_;
};

}  // namespace

std::vector<Eigen::Vector3f> voxel_downsample(const std::vector<Eigen::Vector3f>& points, double cell_m) {
  return voxel_downsample(points, {}, cell_m).points;
}

DownsampledPoints voxel_downsample(const std::vector<Eigen::Vector3f>& points,
                                   const std::vector<float>& times_s, double cell_m) {
  RADIOSLAM_CHECK(times_s.empty() || times_s.size() == points.size(), "one time per point, or none");
  const auto cells_per_m = static_cast<float>(1 / cell_m);
  CellNumbers cells(points.size());
  DownsampledPoints sums;
  std::vector<float> counts;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::uint32_t cell = cells.number_of(voxel_key(voxel_of(points[k], cells_per_m)),
                                               static_cast<std::uint32_t>(counts.size()));
    if (cell == counts.size()) {
      sums.points.emplace_back(Eigen::Vector3f::Zero());
      if (!times_s.empty()) sums.times_s.push_back(0);
      counts.push_back(0);
    }
    sums.points[cell] += points[k];
    if (!times_s.empty()) sums.times_s[cell] += times_s[k];
    counts[cell] += 1;
  }
  for (std::size_t k = 0; k < counts.size(); ++k) sums.points[k] /= counts[k];
  for (std::size_t k = 0; k < sums.times_s.size(); ++k) sums.times_s[k] /= counts[k];
  return sums;
}

std::vector<Surfel> voxel_first(const std::vector<Surfel>& surfels, double cell_m) {
  const auto cells_per_m = static_cast<float>(1 / cell_m);
  CellNumbers cells(surfels.size());
  std::vector<Surfel> kept;
  for (const Surfel& surfel : surfels) {
    const auto next = static_cast<std::uint32_t>(kept.size());
    if (cells.number_of(voxel_key(voxel_of(surfel.position, cells_per_m)), next) == next)
      kept.push_back(surfel);
  }
  return kept;
}

}  // namespace radioslam
