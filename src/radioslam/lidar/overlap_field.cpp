#include "radioslam/lidar/overlap_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace radioslam {
namespace {

constexpr int kReach = 8;  // voxels in the largest search distance
constexpr std::uint8_t kFar = kReach * kReach;
constexpr double kLargest = 255;
constexpr double kFewVoxels = 1U << 16U, kVoxelsPerSurfel = 8192;  // more would be a waste of memory

std::array<std::uint8_t, kFar + 1> values_by_squares() {
  std::array<std::uint8_t, kFar + 1> values{};
  for (int squares = 0; squares < kFar; ++squares)
    values[static_cast<std::size_t>(squares)] =
        static_cast<std::uint8_t>(std::lround(kLargest / (1 + 16.0 * squares / kFar)));
  return values;
}

}  // namespace

OverlapField::OverlapField(const std::vector<Surfel>& surfels, double max_distance_m)
    : voxels_per_m_(static_cast<float>(kReach / max_distance_m)) {
  if (surfels.empty()) return;
  Eigen::Vector3f least = surfels.front().position, most = least;
  for (const Surfel& surfel : surfels) {
    least = least.cwiseMin(surfel.position);
    most = most.cwiseMax(surfel.position);
  }
  const auto voxels = [&] {
    const Eigen::Vector3d extent = (most - least).cast<double>() * static_cast<double>(voxels_per_m_);
    return (extent.array() + 2.0 * kReach).prod();
  };
  const double most_voxels = kFewVoxels + kVoxelsPerSurfel * static_cast<double>(surfels.size());
  while (voxels() > most_voxels) voxels_per_m_ /= 2;
  corner_ = voxel_of(least).array() - (kReach - 1);
  size_ = (voxel_of(most) - corner_).array() + kReach;
  const auto x = static_cast<std::size_t>(size_.x()), y = static_cast<std::size_t>(size_.y()),
             z = static_cast<std::size_t>(size_.z());
  values_.assign(x * y * z, kFar);
  for (const Surfel& surfel : surfels) values_[offset_of(voxel_of(surfel.position) - corner_)] = 0;
  spread(z, 1);
  spread(y, z);
  spread(x, y * z);
  const auto by_squares = values_by_squares();
  for (std::uint8_t& value : values_) value = by_squares[value];
}

void OverlapField::spread(std::size_t count, std::size_t stride) {
  const std::vector<std::uint8_t> before = values_;
  const std::size_t block = count * stride;
  for (std::size_t start = 0; start < values_.size(); start += block)
    for (int steps = 1; steps < kReach; ++steps) {
      const std::size_t apart = static_cast<std::size_t>(steps) * stride;
      if (apart >= block) break;
      const auto farther = static_cast<std::uint8_t>(steps * steps);
      const std::uint8_t* from = before.data() + start;
      std::uint8_t* to = values_.data() + start;
      const auto nearer = [farther](std::uint8_t value, std::uint8_t other) {
        return std::min(value, static_cast<std::uint8_t>(other + farther));  // at most 64 + 49
      };
      for (std::size_t k = 0; k < block - apart; ++k) to[k] = nearer(to[k], from[k + apart]);
      for (std::size_t k = apart; k < block; ++k) to[k] = nearer(to[k], from[k - apart]);
    }
}

Eigen::Vector3i OverlapField::voxel_of(const Eigen::Vector3f& point) const {
  constexpr float kMost = 1e8F;
  return (point * voxels_per_m_).array().floor().max(-kMost).min(kMost).cast<int>();
}

std::size_t OverlapField::offset_of(const Eigen::Vector3i& voxel) const {
  return (static_cast<std::size_t>(voxel.x()) * static_cast<std::size_t>(size_.y()) +
          static_cast<std::size_t>(voxel.y())) *
             static_cast<std::size_t>(size_.z()) +
         static_cast<std::size_t>(voxel.z());
}

std::vector<double> OverlapField::scores(const std::vector<Surfel>& points, const Eigen::Quaterniond& turn,
                                         const std::vector<Eigen::Vector3d>& places) const {
  const Eigen::Matrix3f R = turn.toRotationMatrix().cast<float>();
  std::vector<Eigen::Vector3i> turned;
  for (const Surfel& point : points) turned.push_back(voxel_of(R * point.position) - corner_);
  std::vector<double> scores;
  for (const Eigen::Vector3d& place : places) {
    const Eigen::Vector3i by =
        voxel_of(place.cast<float>() + Eigen::Vector3f::Constant(0.5F / voxels_per_m_));
    std::uint64_t sum = 0;
    for (const Eigen::Vector3i& point : turned) {
      const Eigen::Vector3i voxel = point + by;
      const auto is_within = [](int index, int size) {
        return static_cast<unsigned>(index) < static_cast<unsigned>(size);
      };
      if (is_within(voxel.x(), size_.x()) && is_within(voxel.y(), size_.y()) &&
          is_within(voxel.z(), size_.z()))
        sum += values_[offset_of(voxel)];
    }
    scores.push_back(static_cast<double>(sum) / kLargest /
                     static_cast<double>(std::max<std::size_t>(1, points.size())));
  }
  return scores;
}

}  // namespace radioslam
