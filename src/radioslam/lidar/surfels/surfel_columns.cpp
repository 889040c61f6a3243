#include "radioslam/lidar/surfels/surfel_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace radioslam {
namespace {

constexpr float kColumnsPerReach = 4;
constexpr double kFewColumns = 4096, kColumnsPerSurfel = 64;  // more would be a waste of memory

}  // namespace

SurfelColumns::SurfelColumns(const std::vector<Surfel>& surfels, double max_distance_m)
    : max_distance_m_(max_distance_m),
      column_m_(static_cast<float>(max_distance_m) / kColumnsPerReach),
      surfels_(surfels.size()) {
  if (!surfels.empty()) {
    Eigen::Vector2f least = surfels.front().position.head<2>(), most = least;
    for (const Surfel& surfel : surfels) {
      least = least.cwiseMin(surfel.position.head<2>());
      most = most.cwiseMax(surfel.position.head<2>());
    }
    const auto columns = [&] {
      const Eigen::Vector2f extent = (most - least) / column_m_;
      return (static_cast<double>(extent.x()) + 1) * (static_cast<double>(extent.y()) + 1);
    };
    while (columns() > kFewColumns + kColumnsPerSurfel * static_cast<double>(surfels.size())) column_m_ *= 2;
    lay_out(least, most);
  }
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (std::size_t k = 0; k < surfels.size(); ++k) order.emplace_back(column_of(surfels[k].position), k);
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    const float z_a = surfels[a.second].position.z(), z_b = surfels[b.second].position.z();
    return a.first != b.first ? a.first < b.first : z_a != z_b ? z_a < z_b : a.second < b.second;
  });
  first_.assign(static_cast<std::size_t>(columns_x_) * static_cast<std::size_t>(columns_y_) + 1, 0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    surfels_[k] = surfels[order[k].second];
    positions_.push_back(surfels_[k].position);
    ++first_[order[k].first + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

void SurfelColumns::lay_out(const Eigen::Vector2f& least, const Eigen::Vector2f& most) {
  corner_ = least;
  columns_x_ = static_cast<int>((most.x() - least.x()) / column_m_) + 1;
  columns_y_ = static_cast<int>((most.y() - least.y()) / column_m_) + 1;
}

std::size_t SurfelColumns::column_of(const Eigen::Vector3f& point) const {
  const int x = std::clamp(static_cast<int>((point.x() - corner_.x()) / column_m_), 0, columns_x_ - 1);
  const int y = std::clamp(static_cast<int>((point.y() - corner_.y()) / column_m_), 0, columns_y_ - 1);
  return static_cast<std::size_t>(x) * static_cast<std::size_t>(columns_y_) + static_cast<std::size_t>(y);
}

void SurfelColumns::look_into(std::size_t column, const Eigen::Vector3f& point, Best& best) const {
  const std::uint32_t begin = first_[column], end = first_[column + 1];
  if (begin == end) return;
  const auto above = std::partition_point(positions_.begin() + begin, positions_.begin() + end,
                                          [&](const Eigen::Vector3f& p) { return p.z() < point.z(); });
  const auto middle = static_cast<std::uint32_t>(above - positions_.begin());
  const auto is_beyond = [&](std::uint32_t k) {
    const float dz = positions_[k].z() - point.z();
    if (dz * dz >= best.squared) return true;
    const float squared = (positions_[k] - point).squaredNorm();
    if (squared < best.squared) best = {squared, &surfels_[k]};
    return false;
  };
  for (std::uint32_t k = middle; k < end && !is_beyond(k); ++k) {
  }
  for (std::uint32_t k = middle; k > begin && !is_beyond(k - 1); --k) {
  }
}

const Surfel* SurfelColumns::nearest(const Eigen::Vector3f& point, float squared_max_distance) const {
  const auto reach_m = static_cast<float>(max_distance_m_);
  Best best{std::min(squared_max_distance, reach_m * reach_m)};
  const Eigen::Array2f at = ((point.head<2>() - corner_) / column_m_).array();
  const Eigen::Array2f most(static_cast<float>(columns_x_) + 2 * kColumnsPerReach,
                            static_cast<float>(columns_y_) + 2 * kColumnsPerReach);
  if (!((at > -2 * kColumnsPerReach).all() && (at < most).all())) return nullptr;
  const int home_x = static_cast<int>(std::floor(at.x())), home_y = static_cast<int>(std::floor(at.y()));
  const float off_x = (at.x() - static_cast<float>(home_x)) * column_m_,
              off_y = (at.y() - static_cast<float>(home_y)) * column_m_;
  const float edge_m = std::min({off_x, column_m_ - off_x, off_y, column_m_ - off_y});
  const auto squared_gap = [&](int steps, float off) {
    const float gap = steps == 0  ? 0.0F
                      : steps > 0 ? static_cast<float>(steps) * column_m_ - off
                                  : off - static_cast<float>(steps + 1) * column_m_;
    return gap * gap;
  };
  for (int ring = 0;; ++ring) {
    const float gap_m = static_cast<float>(ring - 1) * column_m_ + edge_m;
    if (ring > 0 && gap_m * gap_m >= best.squared) return best.surfel;
    const int x_end = std::min(ring, columns_x_ - 1 - home_x),
              y_end = std::min(ring, columns_y_ - 1 - home_y);
    for (int dx = std::max(-ring, -home_x); dx <= x_end; ++dx) {
      const float gap_x = squared_gap(dx, off_x);
      if (gap_x >= best.squared) continue;
      const int step = std::abs(dx) == ring ? 1 : std::max(1, 2 * ring);
      for (int dy = -ring; dy <= y_end; dy += step) {
        if (home_y + dy < 0 || gap_x + squared_gap(dy, off_y) >= best.squared) continue;
        look_into(static_cast<std::size_t>(home_x + dx) * static_cast<std::size_t>(columns_y_) +
                      static_cast<std::size_t>(home_y + dy),
                  point, best);
      }
    }
  }
}

}  // namespace radioslam
