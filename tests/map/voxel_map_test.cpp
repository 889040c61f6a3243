// Voxels: means, robots, bounds.
#include "radioslam/map/voxel_map.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

std::vector<MapReturn> return_at(double x, double y, double z, std::uint16_t robot = 0,
                                 std::uint32_t time_ms = 0) {
  return {{{x, y, z}, Eigen::Vector3f::UnitZ(), 0, time_ms, robot}};
}

TEST(VoxelMap, KeepsTheMeanOfEachRobotAndTheFirstTime) {
  VoxelMap map(0.1, 1000);
  map.add(return_at(0.02, -0.03, 5.01, 0, 700));
  map.add(return_at(0.04, -0.05, 5.03, 0, 300));
  map.add(return_at(0.04, -0.05, 5.03, 1));
  map.add(return_at(0.14, -0.05, 5.03, 0));
  ASSERT_EQ(map.voxels().size(), 3);
  const Voxel& first = map.voxels()[0];
  EXPECT_LT((map.position(first) - Eigen::Vector3d(0.03, -0.04, 5.02)).norm(), 1e-5);
  EXPECT_EQ(first.returns, 2);
  EXPECT_EQ(first.time_ms, 300);
  EXPECT_EQ(VoxelMap::robot_of(map.voxels()[1]), 1);
}

TEST(VoxelMap, AsExactFarFromTheOriginAsNear) {
  VoxelMap map(0.1, 1000);
  map.add(return_at(10000.0123, -9000.0456, 300.0789));
  EXPECT_LT((map.position(map.voxels()[0]) - Eigen::Vector3d(10000.0123, -9000.0456, 300.0789)).norm(), 1e-5);
  map.add(return_at(1e7, 0, 0));
  EXPECT_EQ(map.voxels().size(), 1);
  EXPECT_EQ(map.beyond(), 1);
}

TEST(VoxelMap, DoublesItsVoxelsRatherThanGrowBeyondItsBound) {
  VoxelMap map(0.1, 100);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int x = -10; x < 10; ++x)
    for (int y = -10; y < 10; ++y) {
      map.add(return_at(0.1 * x + 0.05, 0.1 * y + 0.05, 0));
      sum += Eigen::Vector3d(0.1 * x + 0.05, 0.1 * y + 0.05, 0);
    }
  EXPECT_DOUBLE_EQ(map.voxel_m(), 0.2);
  ASSERT_LE(map.voxels().size(), 100);
  int returns = 0;
  for (const Voxel& voxel : map.voxels()) {
    returns += voxel.returns;
    sum -= voxel.returns * map.position(voxel);
  }
  EXPECT_EQ(returns, 400);
  EXPECT_LT(sum.norm(), 400 * 1e-5);
}

TEST(VoxelMap, TilesHoldAllVoxelsInTheirPlaces) {
  VoxelMap map(0.1, 10000);
  for (int x = -50; x < 50; x += 3)
    for (int y = -50; y < 50; y += 3) map.add(return_at(0.1 * x + 0.01, 0.1 * y + 0.01, 1));
  const std::size_t all = map.voxels().size();
  const auto tiles = map.sort_into_tiles(2);
  std::size_t next = 0;
  for (const auto& tile : tiles) {
    EXPECT_EQ(tile.begin, next);
    for (std::size_t k = tile.begin; k < tile.end; ++k) {
      const Eigen::Vector3d at = map.position(map.voxels()[k]) / map.tile_width_m();
      EXPECT_EQ(std::floor(at.x()), tile.x);
      EXPECT_EQ(std::floor(at.y()), tile.y);
    }
    next = tile.end;
  }
  EXPECT_EQ(next, all);
}

}  // namespace
}  // namespace radioslam
