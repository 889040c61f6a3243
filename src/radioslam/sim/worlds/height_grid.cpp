#include "radioslam/sim/worlds/height_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// A ray's height above the ground: square t^2 + linear t + constant.
struct HeightAbove {
  double square = 0, linear = 0, constant = 0;

  double at(double t) const { return (square * t + linear) * t + constant; }
  /// The first t from `begin`, where it is positive, to `end` at which it is not.
  std::optional<double> falls_to_zero(double begin, double end) const {
    if (at(begin) <= 0) return begin;  // up to rounding at the border of the cell before
    const double discriminant = linear * linear - 4 * square * constant;
    if (discriminant >= 0) {
      const double sum = -0.5 * (linear + std::copysign(std::sqrt(discriminant), linear));
      const double a = sum / square, b = constant / sum;  // infinite or not a number where there is none
      double first = kFar;
      for (const double root : {a, b})
        if (root > begin && root <= end) first = std::min(first, root);
      if (first < kFar) return first;
    }
    if (at(end) <= 0) return end;
    return std::nullopt;
  }
};

}  // namespace

HeightGrid::HeightGrid(const Eigen::Vector2d& corner_m, double cell_m, Eigen::MatrixXd heights_m)
    : corner_m_(corner_m), cell_m_(cell_m), heights_m_(std::move(heights_m)) {
  RADIOSLAM_CHECK(cell_m > 0 && heights_m_.rows() >= 2 && heights_m_.cols() >= 2, "a grid has a cell");
}

bool HeightGrid::contains(const Cell& cell) const {
  return cell.minCoeff() >= 0 && cell(0) + 1 < heights_m_.rows() && cell(1) + 1 < heights_m_.cols();
}

HeightGrid::Patch HeightGrid::patch(const Cell& cell) const {
  const auto height = [&](Eigen::Index i, Eigen::Index j) { return heights_m_(cell(0) + i, cell(1) + j); };
  const double level = height(0, 0);
  return {level,
          {height(1, 0) - level, height(0, 1) - level},
          height(1, 1) - height(1, 0) - height(0, 1) + level};
}

HeightGrid::Place HeightGrid::place_of(const Eigen::Vector2d& position) const {
  const Eigen::Vector2d size(static_cast<double>(heights_m_.rows() - 1),
                             static_cast<double>(heights_m_.cols() - 1));
  const Eigen::Vector2d place = in_cells(position).cwiseMax(0).cwiseMin(size);
  const Eigen::Vector2d corner = place.array().floor().min(size.array() - 1);
  return {corner.cast<Eigen::Index>().array(), place - corner};
}

double HeightGrid::height_m(const Eigen::Vector2d& position) const {
  const auto [cell, within] = place_of(position);
  const Patch ground = patch(cell);
  return ground.level_m + ground.slope_m.dot(within) + ground.twist_m * within.x() * within.y();
}

Eigen::Vector2d HeightGrid::gradient(const Eigen::Vector2d& position) const {
  const auto [cell, within] = place_of(position);
  const Patch ground = patch(cell);
  return (ground.slope_m + ground.twist_m * Eigen::Vector2d(within.y(), within.x())) / cell_m_;
}

std::optional<double> HeightGrid::ray_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                        double max_m) const {
  const Eigen::Vector2d start = in_cells(origin.head<2>()), along = direction.head<2>() / cell_m_;
  Cell cell = start.array().floor().cast<Eigen::Index>();
  if (!contains(cell) || origin.z() <= height_m(origin.head<2>())) return std::nullopt;
  const Cell step = (along.array() > 0).select(Cell(1, 1), Cell(-1, -1));
  for (double begin_m = 0; begin_m < max_m && contains(cell);) {
    Eigen::Vector2d leaves_m(kFar, kFar);
    for (const int axis : {0, 1})
      if (along(axis) != 0)
        leaves_m(axis) =
            (static_cast<double>(cell(axis) + (along(axis) > 0 ? 1 : 0)) - start(axis)) / along(axis);
    const int axis = leaves_m.x() < leaves_m.y() ? 0 : 1;
    const double end_m = std::clamp(leaves_m(axis), begin_m, max_m);

    const Patch ground = patch(cell);
    const Eigen::Vector2d from = start - cell.matrix().cast<double>();
    const HeightAbove above{
        -ground.twist_m * along.x() * along.y(),
        direction.z() - ground.slope_m.dot(along) -
            ground.twist_m * (from.x() * along.y() + from.y() * along.x()),
        origin.z() - ground.level_m - ground.slope_m.dot(from) - ground.twist_m * from.x() * from.y()};
    if (const auto hit_m = above.falls_to_zero(begin_m, end_m)) return hit_m;
    cell(axis) += step(axis);
    begin_m = end_m;
  }
  return std::nullopt;
}

}  // namespace radioslam
