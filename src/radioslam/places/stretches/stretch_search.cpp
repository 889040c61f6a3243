#include "radioslam/places/stretches/stretch_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <queue>
#include <tuple>

namespace radioslam {
namespace {

constexpr int kTop = StretchGrid::kLevels - 1;

/// Poses of one heading, shifted by less than 2^level cells from x, y along each axis.
struct Block {
  double bound;
  std::uint32_t stretch;
  std::int32_t turn, x, y, level;

  auto rank() const {
    return std::make_tuple(bound, -level, -static_cast<std::int64_t>(stretch), turn, x, y);
  }
  bool operator<(const Block& other) const { return rank() < other.rank(); }
};

class Search {
 public:
  Search(const std::vector<Eigen::Vector2d>& points, const std::vector<SearchedStretch>& stretches,
         const StretchSearchLimits& limits)
      : points_(points), stretches_(stretches), limits_(limits) {
    double squares = 0;
    for (const Eigen::Vector2d& point : points) squares += point.squaredNorm();
    const double extent_m = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, points.size())));
    step_rad_ = StretchGrid::kCell_m / std::max(extent_m, 1.0);
    for (std::size_t s = 0; s < stretches.size(); ++s) add_roots(s);
  }

  std::vector<FoundPlace> places() {
    std::vector<FoundPlace> found;
    std::size_t divided = 0;
    while (!queue_.empty() && found.size() < limits_.max_places) {
      const Block block = queue_.top();
      queue_.pop();
      if (!found.empty() && block.bound < limits_.min_ratio * found.front().score) break;
      if (++divided > limits_.max_blocks) break;
      if (is_known(block, found)) continue;
      if (block.level == 0) {
        found.push_back({block.stretch, pose_of(block), block.bound});
        continue;
      }
      const int half = 1 << (block.level - 1);
      for (const int x : {block.x, block.x + half})
        for (const int y : {block.y, block.y + half})
          add({0, block.stretch, block.turn, x, y, block.level - 1});
    }
    return found;
  }

 private:
  void add_roots(std::size_t s) {
    const SearchedStretch& stretch = stretches_[s];
    const Eigen::Vector2i least = StretchGrid::cell_of(stretch.least),
                          most = StretchGrid::cell_of(stretch.most);
    const auto turn_of = [&](double angle_rad) {
      return static_cast<int>(std::lround(angle_rad / step_rad_));
    };
    const double heading_rad = stretch.T_grid_points.angle();
    const double turn_rad = std::min(stretch.turn_rad, std::numbers::pi);
    for (int turn = turn_of(heading_rad - turn_rad); turn <= turn_of(heading_rad + turn_rad); ++turn)
      for (int x = least.x(); x <= most.x(); x += 1 << kTop)
        for (int y = least.y(); y <= most.y(); y += 1 << kTop)
          add({0, static_cast<std::uint32_t>(s), turn, x, y, kTop});
  }

  struct Turned {
    std::vector<Eigen::Vector2i> cells;
    std::array<Eigen::Vector2i, 2> box;  ///< least and most
  };

  const Turned& turned(int turn) {
    Turned& of = turned_[turn];
    if (!of.cells.empty()) return of;
    const SE2 T({0, 0}, turn * step_rad_);
    for (const Eigen::Vector2d& point : points_) of.cells.push_back(StretchGrid::cell_of(T * point));
    of.box = {of.cells.front(), of.cells.front()};
    for (const Eigen::Vector2i& cell : of.cells) {
      of.box[0] = of.box[0].cwiseMin(cell);
      of.box[1] = of.box[1].cwiseMax(cell);
    }
    return of;
  }

  void add(Block block) {
    const StretchGrid& grid = *stretches_[block.stretch].grid;
    const Turned& of = turned(block.turn);
    const int sum = grid.sum(block.level, of.cells, {block.x, block.y}, of.box);
    block.bound = StretchGrid::score(sum / static_cast<double>(points_.size()));
    if (block.bound >= limits_.min_score) queue_.push(block);
  }

  /// In the middle of the block.
  SE2 pose_of(const Block& block) const {
    const double half = 0.5 * ((1 << block.level) - 1);
    return SE2(Eigen::Vector2d(block.x + half, block.y + half) * StretchGrid::kCell_m,
               block.turn * step_rad_);
  }

  /// Whether all of its poses are near to a place that was found.
  bool is_known(const Block& block, const std::vector<FoundPlace>& found) const {
    const double half_m = 0.75 * ((1 << block.level) - 1) * StretchGrid::kCell_m;
    if (half_m >= limits_.same_m) return false;
    const SE2 T_world_points = stretches_[block.stretch].T_world_grid * pose_of(block);
    return std::any_of(found.begin(), found.end(), [&](const FoundPlace& place) {
      const SE2 other = stretches_[place.stretch].T_world_grid * place.T_grid_points;
      return (other.translation() - T_world_points.translation()).norm() <= limits_.same_m - half_m &&
             std::abs(wrap_angle(other.angle() - T_world_points.angle())) <= limits_.same_rad;
    });
  }

  const std::vector<Eigen::Vector2d>& points_;
  const std::vector<SearchedStretch>& stretches_;
  StretchSearchLimits limits_;
  double step_rad_ = 0;
  std::map<int, Turned> turned_;
  std::priority_queue<Block> queue_;
};

}  // namespace

std::vector<FoundPlace> search_stretches(const std::vector<Eigen::Vector2d>& points,
                                         const std::vector<SearchedStretch>& stretches,
                                         const StretchSearchLimits& limits) {
  if (points.empty()) return {};
  return Search(points, stretches, limits).places();
}

}  // namespace radioslam
