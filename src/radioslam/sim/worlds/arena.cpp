#include "radioslam/sim/worlds/arena.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace radioslam {
namespace {

constexpr double kSmallestBox_m = 3, kLargestBox_m = 8;
constexpr double kGangway_m = 2;
constexpr double kRobot_m = 0.3;  ///< clearance between a robot's centre and walls
constexpr int kTries = 200;

void add_walls(const ArenaBox& box, std::vector<WallSegment>& walls) {
  const Eigen::Vector2d a = box.low_m, c = box.high_m, b(c.x(), a.y()), d(a.x(), c.y());
  for (const auto& [begin, end] : {std::pair(a, b), std::pair(b, c), std::pair(c, d), std::pair(d, a)}) {
    WallSegment wall;
    wall.begin_m = begin;
    wall.end_m = end;
    walls.push_back(wall);
  }
}

bool is_within(const Eigen::Vector2d& place, const ArenaBox& box, double margin_m) {
  return (place.array() > box.low_m.array() - margin_m).all() &&
         (place.array() < box.high_m.array() + margin_m).all();
}

bool overlap(const ArenaBox& a, const ArenaBox& b, double margin_m) {
  return (a.low_m.array() < b.high_m.array() + margin_m).all() &&
         (b.low_m.array() < a.high_m.array() + margin_m).all();
}

}  // namespace

Arena::Arena(double side_m, int boxes, Rng rng) : side_m_(side_m) {
  add_walls({Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(side_m)}, walls_);
  for (int tries = 0; tries < kTries * boxes && static_cast<int>(boxes_.size()) < boxes; ++tries) {
    const double largest = std::min(kLargestBox_m, side_m / 4);
    // One after the other: compilers evaluate arguments in different orders.
    const double smallest = std::min(kSmallestBox_m, largest / 2);
    const double height_m = rng.uniform(smallest, largest), width_m = rng.uniform(smallest, largest);
    const double low_y = rng.uniform(kGangway_m, side_m - height_m - kGangway_m);
    const double low_x = rng.uniform(kGangway_m, side_m - width_m - kGangway_m);
    const Eigen::Vector2d low(low_x, low_y), size(width_m, height_m);
    const ArenaBox box{low, low + size};
    if (std::any_of(boxes_.begin(), boxes_.end(),
                    [&](const ArenaBox& other) { return overlap(box, other, kGangway_m); }))
      continue;
    boxes_.push_back(box);
    add_walls(box, walls_);
  }
}

Eigen::Vector2d Arena::free_place(Rng& rng) const {
  Eigen::Vector2d place;
  do {
    place = {rng.uniform(2 * kRobot_m, side_m_ - 2 * kRobot_m),
             rng.uniform(2 * kRobot_m, side_m_ - 2 * kRobot_m)};
  } while (std::any_of(boxes_.begin(), boxes_.end(),
                       [&](const ArenaBox& box) { return is_within(place, box, 2 * kRobot_m); }));
  return place;
}

Eigen::Vector2d Arena::reach(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  const Eigen::Vector2d way = to - from;
  const double length = way.norm();
  if (length == 0) return from;
  const Eigen::Vector2d ahead = way / length;
  double free_m = length;
  for (const WallSegment& wall : walls_)
    if (const auto at = crossing(from, to + kRobot_m * ahead, wall))
      free_m = std::min(free_m, *at * (length + kRobot_m) - kRobot_m);
  return from + std::max(0.0, free_m) * ahead;
}

std::optional<double> Arena::wall_ahead(const Eigen::Vector2d& from, double heading_rad,
                                        double range_m) const {
  const Eigen::Vector2d to = from + range_m * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  double nearest = std::numeric_limits<double>::infinity();
  for (const WallSegment& wall : walls_)
    if (const auto at = crossing(from, to, wall)) nearest = std::min(nearest, *at * range_m);
  return std::isfinite(nearest) ? std::optional(nearest) : std::nullopt;
}

bool Arena::in_sight(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  return std::none_of(walls_.begin(), walls_.end(),
                      [&](const WallSegment& wall) { return crossing(a, b, wall).has_value(); });
}

}  // namespace radioslam
