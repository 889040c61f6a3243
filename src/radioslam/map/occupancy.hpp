// Occupancy grid of a team by ray casting, seen from above.
//
// A scan is divided into columns of azimuth. In a column, a return within the slice of heights in which
// robots drive hits its cell, and the rays of the column see through the cells in front of the farthest point
// where one of them is still in the slice. A scan counts once in a cell, and a cell that it hits is not one
// that it sees through. A cell is
//
//   occupied   if its hits are at least `min_occupied_ratio` of all scans in it
//   free       if scans saw through it, otherwise
//   unknown    without either, or with a tenth of a neighbour's hits, which are the noise of that
//
// so that what moves away becomes free. Heights are those above the ground under the robot. All returns of a
// planar scanner are in the slice. Cost: the cells along the columns' rays; 8 bytes per cell.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "radioslam/map/map_params.hpp"
#include "radioslam/map/placed_scan.hpp"
#include "radioslam/results/map_result.hpp"

namespace radioslam {

class OccupancyBuilder {
 public:
  /// Over `bounds`, by cells of params.cell_m, which is doubled until there are at most params.max_cells.
  OccupancyBuilder(const Eigen::AlignedBox2d& bounds, const MapParams& params);

  void add(const PlacedScan& scan, const MappedRobot& robot);

  /// Cut to the cells that are known.
  OccupancyGrid grid() const;

 private:
  struct Cell {
    std::uint16_t hits = 0, through = 0;
    std::uint32_t last = 0;  ///< the scan that counted here last
  };
  /// What a column of azimuth sees: a ray as far as its rays are in the slice.
  struct Column {
    double from_m = 0, to_m = 0;
    Eigen::Vector2d origin, direction;
  };

  /// Fills columns_ and counts the returns.
  void gather(const PlacedScan& scan, const MappedRobot& robot);
  void count_hit(const Eigen::Vector2d& position);
  void count_through(const Column& column);
  Cell* cell_at(const Eigen::Vector2d& position);
  const Cell& cell(std::int64_t x, std::int64_t y) const;
  CellState state_of(std::int64_t x, std::int64_t y) const;

  MapParams params_;
  double cell_m_ = 0;
  Eigen::Vector2d origin_m_;
  std::int64_t width_ = 0, height_ = 0;
  std::uint32_t scan_ = 0;
  std::vector<Cell> cells_;
  std::vector<Column> columns_;
};

}  // namespace radioslam
