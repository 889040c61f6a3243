// The map of a team at true poses: accuracy, normals, crop, determinism.
#include "radioslam/map/team_map.hpp"

#include <gtest/gtest.h>

#include "map/street.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

street::Street short_street() {
  street::Street street;
  street.duration_s = 8;
  street.steps = 240;
  return street;
}

struct Listed {
  Eigen::Vector3d position;
  MapPoint point;
};

std::vector<Listed> points_of(const TeamMap& map) {
  std::vector<Listed> all;
  map.for_each_point([&](const Eigen::Vector3d& at, const MapPoint& point) { all.push_back({at, point}); });
  return all;
}

TEST(TeamMap, PointsLieOnTheSurfacesThatWereScannedWithTheirNormals) {
  const street::Street street = short_street();
  const TeamMap map(street::robots(street, 2), ScanPointParams{}, MapParams{});
  const auto points = points_of(map);
  ASSERT_GT(points.size(), 20000);
  EXPECT_EQ(points.size(), map.result().all_points);
  std::size_t off = 0, floor = 0, up = 0;
  for (const auto& [at, point] : points) {
    if (!street.is_static(at, 0.1)) ++off;
    if (at.z() > 0.03 || std::abs(at.y()) > 4 || point.normal.isZero()) continue;
    ++floor;
    if (point.normal.z() > 0.95F) ++up;
  }
  EXPECT_LT(static_cast<double>(off), 0.001 * static_cast<double>(points.size()));
  EXPECT_GT(static_cast<double>(up), 0.95 * static_cast<double>(floor));
}

TEST(TeamMap, EachRobotsPointsLieOnTheOthersSurfaces) {
  const street::Street street = short_street();
  const auto points = points_of(TeamMap(street::robots(street, 2), ScanPointParams{}, MapParams{}));
  VoxelMap of_b(0.1, 1000000);
  for (const auto& [at, point] : points)
    if (point.robot == 1) of_b.add(std::vector<MapReturn>{{at, Eigen::Vector3f::UnitZ(), 0, 0, 0}});
  std::size_t common = 0, near = 0;
  for (const auto& [at, point] : points) {
    if (point.robot != 0) continue;
    if (point.normal.isZero()) continue;
    double least = 0.2, off = 0;
    for (const Voxel& voxel : of_b.voxels()) {
      const Eigen::Vector3d way = of_b.position(voxel) - at;
      if (way.norm() < least) least = way.norm(), off = std::abs(way.dot(point.normal.cast<double>()));
    }
    if (least == 0.2) continue;  // b has not been there
    ++common;
    if (off < 0.05) ++near;
    if (common == 1000) break;
  }
  ASSERT_GT(common, 500);
  EXPECT_GT(static_cast<double>(near), 0.95 * static_cast<double>(common));
}

TEST(TeamMap, CropLeavesOutWhatIsOutside) {
  const street::Street street = short_street();
  const Eigen::AlignedBox3d crop(Eigen::Vector3d(0, -3, -1), Eigen::Vector3d(12, 3, 0.5));
  const TeamMap map(street::robots(street, 1), ScanPointParams{}, MapParams{}, {crop, {}});
  ASSERT_GT(map.result().all_points, 100);
  map.for_each_point(
      [&](const Eigen::Vector3d& at, const MapPoint&) { EXPECT_TRUE(crop.contains(at)) << at.transpose(); });
  EXPECT_LE(static_cast<double>(map.result().grid.width) * map.result().grid.cell_m, 12.2);
}

TEST(TeamMap, IsTheSameForAnyNumberOfThreads) {
  const street::Street street = short_street();
  const auto make = [&](std::size_t threads) {
    set_thread_count(threads);
    return points_of(TeamMap(street::robots(street, 2), ScanPointParams{}, MapParams{}));
  };
  const auto one = make(1), three = make(3);
  set_thread_count(0);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    ASSERT_EQ(one[k].position, three[k].position);
    ASSERT_EQ(one[k].point.normal, three[k].point.normal);
  }
}

}  // namespace
}  // namespace radioslam
