// Ground of any shape: heights on a square grid, bilinear between them, and its intersection with rays.
//
// Over a cell, a ray's height above the ground is a quadratic of its length, so hits are exact up to
// rounding. There is no ground beside the grid. Cost of a ray: the cells that it passes.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace radioslam {

class HeightGrid {
 public:
  /// heights_m(i, j) is the height at corner_m + cell_m (i, j); at least two along each axis.
  HeightGrid(const Eigen::Vector2d& corner_m, double cell_m, Eigen::MatrixXd heights_m);

  /// Beside the grid as at its border.
  double height_m(const Eigen::Vector2d& position) const;
  Eigen::Vector2d gradient(const Eigen::Vector2d& position) const;
  /// Distance along a unit vector from a point above the ground to its first intersection with the ground.
  /// Nothing beyond `max_m`, from below the ground or from beside the grid.
  std::optional<double> ray_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                              double max_m) const;

 private:
  using Cell = Eigen::Array<Eigen::Index, 2, 1>;
  /// Height over a cell: level + slope . x + twist x y, with x in cells from its corner.
  struct Patch {
    double level_m = 0;
    Eigen::Vector2d slope_m;
    double twist_m = 0;
  };

  bool contains(const Cell& cell) const;
  Patch patch(const Cell& cell) const;
  /// In cells from the grid's corner.
  Eigen::Vector2d in_cells(const Eigen::Vector2d& position) const { return (position - corner_m_) / cell_m_; }
  /// The nearest cell to a position, and the nearest place in it, in cells from the cell's corner.
  struct Place {
    Cell cell;
    Eigen::Vector2d within;
  };
  Place place_of(const Eigen::Vector2d& position) const;

  Eigen::Vector2d corner_m_;
  double cell_m_;
  Eigen::MatrixXd heights_m_;
};

}  // namespace radioslam
