// The occupancy image of scans: walls of a room, and neither its floor nor its ceiling.
#include "radioslam/pipeline/occupancy_image.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lidar/scan_drive.hpp"

namespace radioslam {
namespace {

using namespace test;

/// The image of a drive whose estimate is the truth.
RunResult picture_of_drive(const Scanner& scanner, const OccupancyImageParams& params = {}) {
  const ScanDrive drive = drive_along(furnished_room(), scanner, around_furnished_room(40), 3);
  Mission mission;
  Robot& robot = mission.robots.emplace_back();
  robot.lidar = log_of(drive);
  RunResult result;
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t k = 0; k < drive.truth.size(); ++k) rows.push_back({drive.stamps[k], drive.truth[k]});
  result.robots.emplace_back().estimate = Trajectory<SE3>(rows);
  result.robots[0].dense = result.robots[0].estimate;
  add_occupancy_images(result, mission, {}, params);
  return result;
}

/// Horizontal distance from a point to the nearest upright surface of the furnished room.
double to_nearest_wall_m(const Eigen::Vector2d& point) {
  double nearest = kNothing_m;
  for (int degree = 0; degree < 360; degree += 3) {
    const Eigen::Vector3d ray(std::cos(degree * kDegree), std::sin(degree * kDegree), 0);
    nearest = std::min(nearest, distance_to(furnished_room(), {point.x(), point.y(), 1}, ray));
  }
  return nearest;
}

double share_of_cells_at_walls(const OccupancyImageResult& picture) {
  double at_walls = 0;
  for (const ScanCell& cell : picture.cells)
    at_walls += to_nearest_wall_m(picture.cell_m * Eigen::Vector2d(cell.x + 0.5, cell.y + 0.5)) <
                1.5 * picture.cell_m;
  return at_walls / static_cast<double>(picture.cells.size());
}

/// A steep field of view, so that most points are on the floor and the ceiling.
Scanner steep_scanner() {
  Scanner scanner;
  scanner.beams = 32;
  scanner.azimuths = 180;
  scanner.lowest_rad = -60 * kDegree;
  scanner.highest_rad = 60 * kDegree;
  return scanner;
}

TEST(OccupancyImage, HasWallsWithoutFloorsAndCeilings) {
  const auto result = picture_of_drive(steep_scanner());
  ASSERT_TRUE(result.robots[0].picture);
  EXPECT_GT(result.robots[0].picture->cells.size(), 100U);
  EXPECT_GT(share_of_cells_at_walls(*result.robots[0].picture), 0.97);
  OccupancyImageParams with_floors;
  with_floors.min_heights = 1;
  with_floors.min_height_ratio = 0;
  const auto all = picture_of_drive(steep_scanner(), with_floors);
  EXPECT_LT(share_of_cells_at_walls(*all.robots[0].picture), 0.6);
}

TEST(OccupancyImage, OfAPlanesScansHasAllThatTheyHit) {
  const auto result = picture_of_drive(planar_scanner());
  EXPECT_GT(result.robots[0].picture->cells.size(), 100U);
  EXPECT_GT(share_of_cells_at_walls(*result.robots[0].picture), 0.97);
}

TEST(OccupancyImage, HasNoMoreCellsAndScansThanItMay) {
  OccupancyImageParams params;
  params.max_cells = 50;
  params.max_scans = 10;
  const auto picture = *picture_of_drive(planar_scanner(), params).robots[0].picture;
  EXPECT_LE(picture.cells.size(), 50U);
  EXPECT_GT(picture.cells.size(), 5U);
  EXPECT_EQ(picture.scans, 10U);
  EXPECT_GT(share_of_cells_at_walls(picture), 0.9);
}

}  // namespace
}  // namespace radioslam
