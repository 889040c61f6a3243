// What a planar scanner saw on a stretch of its way, as a grid of cells that are occupied, free or unseen.
//
//   occupied   points end there, and not eight times as many rays pass
//   free       rays pass, and no occupied cell is within two cells
//   value      255 where occupied, less up to two cells away, 64 where nothing was seen, 0 where it is free:
//              a point where it is free lowers a pose's score, and one where nothing was seen leaves it
// Coarser levels bound the value from above: those of level l have 2^l cells to a side, and hold the largest
// value that a point in them may reach when it is shifted by less than 2^l cells along each axis.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {

/// A planar scan on a stretch.
struct StretchView {
  SE2 T_stretch_scan;
  std::vector<Eigen::Vector2d> points;
};

class StretchGrid {
 public:
  static constexpr int kLevels = 6;
  static constexpr int kUnseen = 64, kOccupied = 255, kNear = 130;
  static constexpr double kCell_m = 0.15;

  /// Of points and rays up to this range.
  StretchGrid(const std::vector<StretchView>& views, double range_m);

  /// Of the mean value of points: 1 where all are occupied, 0 where all are unseen.
  static double score(double value) { return (value - kUnseen) / (kOccupied - kUnseen); }
  static Eigen::Vector2i cell_of(const Eigen::Vector2d& point) {
    return (point / kCell_m).array().floor().cast<int>();
  }
  int value(int level, const Eigen::Vector2i& cell) const {
    const Level& of = levels_[static_cast<std::size_t>(level)];
    const int x = ((cell.x() - corner_.x()) >> level), y = ((cell.y() - corner_.y()) >> level);
    if (static_cast<unsigned>(x) >= static_cast<unsigned>(of.width) ||
        static_cast<unsigned>(y) >= static_cast<unsigned>(of.height))
      return kUnseen;
    return of.values[static_cast<std::size_t>(x) * static_cast<std::size_t>(of.height) +
                     static_cast<std::size_t>(y)];
  }
  /// Sum of the values of cells shifted by this; `box`: least and most of the cells.
  int sum(int level, const std::vector<Eigen::Vector2i>& cells, const Eigen::Vector2i& shift,
          const std::array<Eigen::Vector2i, 2>& box) const;
  /// Centres of the occupied cells, in the order of their coordinates.
  const std::vector<Eigen::Vector2d>& occupied() const { return occupied_; }

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint8_t> values;  ///< x slowest
  };

  void make_coarser(std::size_t level);

  Eigen::Vector2i corner_ = Eigen::Vector2i::Zero();
  std::array<Level, kLevels> levels_;
  std::vector<Eigen::Vector2d> occupied_;
};

/// How two stretches' grids agree at a relative pose, by the occupied cells of each on the other.
struct StretchLikeness {
  double met = 0;      ///< share that lies on or next to what is occupied
  double against = 0;  ///< share that lies where it is free
  double score = 0;    ///< mean value (see stretch_search.hpp)

  double seen() const { return met + against; }
  double agreement() const { return seen() > 0 ? met / seen() : 0; }
};
StretchLikeness likeness(const StretchGrid& a, const StretchGrid& b, const SE2& T_a_b);

}  // namespace radioslam
