#include "radioslam/sim/worlds/lane_grid.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

using Lane = std::pair<std::size_t, std::size_t>;

double distance_to_segment_m(const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                             const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double ratio = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - a - ratio * along).norm();
}

/// `count` centre lines, evenly spaced from margin to size - margin.
double centre_line_m(int index, int count, double size_m, double margin_m) {
  return margin_m + (size_m - 2 * margin_m) * index / (count - 1);
}

/// Lanes between adjacent crossings of a grid with `columns` x `rows` crossings, numbered row by row.
std::vector<Lane> grid_lanes(std::size_t columns, std::size_t rows) {
  std::vector<Lane> lanes;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t here = row * columns + column;
      if (column + 1 < columns) lanes.emplace_back(here, here + 1);
      if (row + 1 < rows) lanes.emplace_back(here, here + columns);
    }
  return lanes;
}

void shuffle(std::vector<Lane>& lanes, Rng& rng) {
  for (std::size_t i = lanes.size(); i > 1; --i) std::swap(lanes[i - 1], lanes[rng.below(i)]);
}

}  // namespace

LaneGrid::LaneGrid(const LaneGridParams& params, Rng rng) {
  RADIOSLAM_CHECK(params.aisles_along_x >= 2 && params.aisles_along_y >= 2,
                  "a grid needs two aisles in each direction");
  for (int row = 0; row < params.aisles_along_x; ++row)
    for (int column = 0; column < params.aisles_along_y; ++column)
      crossings_.emplace_back(centre_line_m(column, params.aisles_along_y, params.floor_x_m, params.margin_m),
                              centre_line_m(row, params.aisles_along_x, params.floor_y_m, params.margin_m));
  neighbours_.resize(crossings_.size());

  auto lanes = grid_lanes(static_cast<std::size_t>(params.aisles_along_y),
                          static_cast<std::size_t>(params.aisles_along_x));
  for (const auto& [i, j] : lanes) open_lane(i, j);
  auto to_close = static_cast<std::size_t>(params.closed_lane_ratio * static_cast<double>(lanes.size()));
  shuffle(lanes, rng);
  for (const auto& [i, j] : lanes) {
    if (to_close == 0) break;
    if (neighbours_[i].size() <= 2 || neighbours_[j].size() <= 2) continue;
    close_lane(i, j);
    if (connected())
      --to_close;
    else
      open_lane(i, j);
  }
}

std::size_t LaneGrid::lane_count() const {
  std::size_t ends = 0;
  for (const auto& list : neighbours_) ends += list.size();
  return ends / 2;
}

double LaneGrid::distance_to_lane_m(const Eigen::Vector2d& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size(); ++i)
    for (const std::size_t j : neighbours_[i])
      if (i < j) nearest = std::min(nearest, distance_to_segment_m(point, crossings_[i], crossings_[j]));
  return nearest;
}

void LaneGrid::open_lane(std::size_t i, std::size_t j) {
  const auto insert = [](std::vector<std::size_t>& list, std::size_t value) {
    list.insert(std::lower_bound(list.begin(), list.end(), value), value);
  };
  insert(neighbours_[i], j);
  insert(neighbours_[j], i);
}

void LaneGrid::close_lane(std::size_t i, std::size_t j) {
  std::erase(neighbours_[i], j);
  std::erase(neighbours_[j], i);
}

bool LaneGrid::connected() const {
  std::vector<bool> reached(size(), false);
  std::vector<std::size_t> open{0};
  reached[0] = true;
  std::size_t count = 0;
  while (!open.empty()) {
    const std::size_t here = open.back();
    open.pop_back();
    ++count;
    for (const std::size_t next : neighbours_[here]) {
      if (reached[next]) continue;
      reached[next] = true;
      open.push_back(next);
    }
  }
  return count == size();
}

}  // namespace radioslam
