// Ray casting in a static world: ground, optional ceiling, upright boxes and pillars (upright_shapes.hpp).
//
// Exact: hits follow from each shape's own equation; the grid of the floor only skips shapes that the ray
// cannot hit. Common frame, metres. Cost of a ray: the cells that it passes, and the shapes in them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "radioslam/sim/worlds/height_grid.hpp"
#include "radioslam/sim/worlds/hills.hpp"
#include "radioslam/sim/worlds/upright_shapes.hpp"

namespace radioslam {

/// Floor grid for ray casting: the shapes in each cell of the floor, and the sequence of cells under a ray.
///
/// Cells are traversed as in Amanatides and Woo 1987. Their size yields a few cells per shape. Memory: cells,
/// and shapes times the cells that they cover.
class FloorGrid {
 public:
  /// No shapes, no cells.
  FloorGrid() = default;
  /// From the footprints of shapes, which are identified by their index in this list.
  explicit FloorGrid(const std::vector<Eigen::AlignedBox2d>& footprints);

  /// Traversal of the cells under a ray, from its origin to `most` times its direction (seen from above; not
  /// of unit length), starting in the first cell of the grid that it touches.
  class Walk {
   public:
    Walk(const FloorGrid& grid, const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double most);
    bool over() const { return over_; }
    /// The shapes in this cell.
    std::span<const std::uint32_t> shapes() const;
    /// Ray parameter at which the ray leaves this cell, in lengths of its direction.
    double leaves() const { return std::min({next_[0], next_[1], end_}); }
    void go_on();

   private:
    const FloorGrid& grid_;
    double end_ = 0;
    bool over_ = true;
    std::array<std::ptrdiff_t, 2> cell_{};
    std::array<std::ptrdiff_t, 2> step_{};
    std::array<double, 2> next_{};     ///< ray parameter at the next column, row
    std::array<double, 2> spacing_{};  ///< from one column, row to the next
  };

 private:
  std::ptrdiff_t cell_of(double coordinate_m, int axis) const;
  std::size_t index_of(const std::array<std::ptrdiff_t, 2>& cell) const {
    return static_cast<std::size_t>(cell[1] * count_[0] + cell[0]);
  }
  /// Calls visit(index of the cell) for each cell that the rectangle touches.
  template <class Visit>
  void for_each_cell(const Eigen::AlignedBox2d& rectangle, const Visit& visit) const;

  Eigen::AlignedBox2d bounds_;  ///< empty without shapes
  double cell_m_ = 1;
  std::array<std::ptrdiff_t, 2> count_{};
  std::vector<std::uint32_t> begin_;   ///< per cell the begin of its shapes in shapes_, then the end
  std::vector<std::uint32_t> shapes_;  ///< cell by cell
};

/// All surfaces of a world.
struct WorldShapes {
  std::variant<Hills, HeightGrid> ground;  ///< z = 0 by default
  std::optional<double> ceiling_m;         ///< an infinite horizontal plane
  std::vector<UprightBox> boxes;
  std::vector<UprightPillar> pillars;
};

class RayWorld {
 public:
  explicit RayWorld(WorldShapes shapes);

  /// The first hit; nothing if there is no surface within `max_m`.
  std::optional<RayHit> cast(const Ray& ray, double max_m) const;

 private:
  std::optional<RayHit> cast_at_ground(const Ray& ray, double max_m) const;
  std::optional<RayHit> cast_at_ceiling(const Ray& ray, double max_m) const;
  std::optional<RayHit> cast_at_shape(const Ray& ray, std::size_t shape) const;

  WorldShapes shapes_;
  FloorGrid grid_;  ///< of the boxes, then the pillars
};

}  // namespace radioslam
