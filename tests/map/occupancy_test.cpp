// Occupancy grid by ray casting, against a known wall.
#include "radioslam/map/occupancy.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace radioslam {
namespace {

CellState state_at(const OccupancyGrid& grid, double x, double y) {
  const auto column = static_cast<std::ptrdiff_t>(std::floor((x - grid.origin_m.x()) / grid.cell_m));
  const auto row = static_cast<std::ptrdiff_t>(std::floor((y - grid.origin_m.y()) / grid.cell_m));
  if (column < 0 || row < 0 || column >= static_cast<std::ptrdiff_t>(grid.width) ||
      row >= static_cast<std::ptrdiff_t>(grid.height))
    return CellState::kUnknown;
  return grid.cells[static_cast<std::size_t>(row) * grid.width + static_cast<std::size_t>(column)];
}

/// A scanner in the body's origin that sees a wall at x = 3.05 from y = -2 to 2, at this height.
PlacedScan scan_of_wall(const SE3& T_frame_body, double height_m) {
  PlacedScan scan;
  scan.T_frame_body = T_frame_body;
  for (double y = -2; y <= 2; y += 0.01)
    scan.returns.points.push_back(Eigen::Vector3d(3.05, y, height_m).cast<float>());
  return scan;
}

const Eigen::AlignedBox2d kBounds(Eigen::Vector2d(-10, -10), Eigen::Vector2d(10, 10));

TEST(Occupancy, AWallIsOccupiedWhatIsBeforeItFreeAndBehindItUnknown) {
  const MappedRobot robot{"a", {}, {}, ScannerKind::kPlanar, {}};
  OccupancyBuilder builder(kBounds, MapParams{});
  // A quarter turn left at (1, 2): the wall is at y = 5.05, from x = -1 to 3.
  builder.add(scan_of_wall(lift(SE2({1, 2}, std::numbers::pi / 2)), 0), robot);
  const OccupancyGrid grid = builder.grid();
  EXPECT_DOUBLE_EQ(grid.cell_m, 0.1);
  for (const double x : {-0.85, 0.05, 1.05, 2.85}) {
    EXPECT_EQ(state_at(grid, x, 5.05), CellState::kOccupied) << x;
    EXPECT_EQ(state_at(grid, x, 5.25), CellState::kUnknown) << x;
  }
  for (const double y : {2.55, 3.55, 4.85}) EXPECT_EQ(state_at(grid, 1.05, y), CellState::kFree) << y;
  EXPECT_EQ(state_at(grid, 1.05, 1.05), CellState::kUnknown);
}

TEST(Occupancy, ReturnsOutsideOfTheSliceOccupyNothing) {
  MappedRobot robot{"a", {}, {}, ScannerKind::kSpatial, {}};
  robot.geometry.scanner_m.z() = 1;
  OccupancyBuilder builder(kBounds, MapParams{});
  builder.add(scan_of_wall(SE3(), 0.1), robot);  // a floor below the slice
  const OccupancyGrid grid = builder.grid();
  EXPECT_EQ(state_at(grid, 3.05, 0.05), CellState::kUnknown);
  EXPECT_EQ(state_at(grid, 1.05, 0.05), CellState::kFree);  // the ray is still in the slice
}

TEST(Occupancy, WhatMovesAwayBecomesFree) {
  const MappedRobot robot{"a", {}, {}, ScannerKind::kPlanar, {}};
  OccupancyBuilder builder(kBounds, MapParams{});
  builder.add(scan_of_wall(SE3(), 0), robot);
  for (int k = 0; k < 5; ++k) {
    PlacedScan farther = scan_of_wall(SE3(), 0);
    for (Eigen::Vector3f& point : farther.returns.points) point *= 2.1F;
    builder.add(farther, robot);
  }
  const OccupancyGrid grid = builder.grid();
  EXPECT_EQ(state_at(grid, 3.05, 0.05), CellState::kFree);
  EXPECT_EQ(state_at(grid, 6.45, 0.05), CellState::kOccupied);
}

TEST(Occupancy, CellsAreWidenedUntilThereAreFewEnough) {
  MapParams params;
  params.max_cells = 5000;
  EXPECT_DOUBLE_EQ(OccupancyBuilder(kBounds, params).grid().cell_m, 0.4);
}

}  // namespace
}  // namespace radioslam
