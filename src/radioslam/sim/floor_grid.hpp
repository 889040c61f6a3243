// Which shapes stand in which cell of the floor, and the cells over which a ray passes, one after the other.
//
// The walk from cell to cell is that of Amanatides and Woo 1987. Cells are as large as leaves a few of them
// per shape. Memory: cells, and shapes times the cells that they cover.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace radioslam {

class FloorGrid {
 public:
  /// No shapes, no cells.
  FloorGrid() = default;
  /// Of shapes by what they cover of the floor; they are called by their places in this list.
  explicit FloorGrid(const std::vector<Eigen::AlignedBox2d>& footprints);

  /// A walk over the cells on a ray's way, from its origin to `most` times its direction (from above; not of
  /// unit length), begun in the first cell of the grid on it.
  class Walk {
   public:
    Walk(const FloorGrid& grid, const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double most);
    bool over() const { return over_; }
    /// The shapes in this cell.
    std::span<const std::uint32_t> shapes() const;
    /// Where the ray leaves this cell, in lengths of its direction.
    double leaves() const { return std::min({next_[0], next_[1], end_}); }
    void go_on();

   private:
    const FloorGrid& grid_;
    double end_ = 0;
    bool over_ = true;
    std::array<std::ptrdiff_t, 2> cell_{};
    std::array<std::ptrdiff_t, 2> step_{};
    std::array<double, 2> next_{};     ///< where the ray crosses into the next column, row
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
  std::vector<std::uint32_t> begin_;   ///< per cell where its shapes begin in `shapes_`, and the end
  std::vector<std::uint32_t> shapes_;  ///< cell by cell
};

}  // namespace radioslam
