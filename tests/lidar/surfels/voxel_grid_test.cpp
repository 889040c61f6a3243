#include "radioslam/lidar/surfels/voxel_grid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

using CellIndex = std::array<long, 3>;

CellIndex cell_of(const Eigen::Vector3f& point, double cell_m) {
  CellIndex cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[static_cast<std::size_t>(axis)] = std::lround(std::floor(static_cast<double>(point[axis]) / cell_m));
  return cell;
}

std::vector<Eigen::Vector3f> points_about(const Eigen::Vector3d& centre, double max_distance_m, int count,
                                          std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < count; ++k) {
    const double x = rng.uniform(-max_distance_m, max_distance_m),
                 y = rng.uniform(-max_distance_m, max_distance_m);
    const double z = rng.uniform(-max_distance_m, max_distance_m);
    points.emplace_back((centre + Eigen::Vector3d(x, y, z)).cast<float>());
  }
  return points;
}

/// The means of the cells, computed with a sorted map, in the order of their first points.
std::vector<Eigen::Vector3d> means_of_cells(const std::vector<Eigen::Vector3f>& points, double cell_m) {
  std::map<CellIndex, std::pair<Eigen::Vector3d, int>> sums;
  std::vector<CellIndex> order;
  for (const Eigen::Vector3f& point : points) {
    const CellIndex cell = cell_of(point, cell_m);
    const auto [at, is_new] = sums.try_emplace(cell, Eigen::Vector3d::Zero(), 0);
    if (is_new) order.push_back(cell);
    at->second.first += point.cast<double>();
    ++at->second.second;
  }
  std::vector<Eigen::Vector3d> means;
  for (const CellIndex& cell : order) means.emplace_back(sums[cell].first / sums[cell].second);
  return means;
}

void expect_means(const std::vector<Eigen::Vector3f>& points, double cell_m) {
  const auto expected = means_of_cells(points, cell_m);
  const auto thinned = voxel_downsample(points, cell_m);
  ASSERT_EQ(thinned.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    ASSERT_LT((thinned[k].cast<double>() - expected[k]).norm(), 1e-4) << k;
}

TEST(ThinByVoxels, TakesTheMeanOfEveryCellInTheOrderOfTheirFirstPoints) {
  expect_means(points_about({0, 0, 0}, 3, 4000, 1), 0.5);    // many points in a cell, on both sides of zero
  expect_means(points_about({0, 0, 0}, 30, 20000, 2), 0.5);  // mostly one
  expect_means(points_about({-700, 300, -40}, 5, 4000, 3), 0.25);
}

TEST(ThinByVoxels, SeparatesCellsOnEitherSideOfZero) {
  const std::vector<Eigen::Vector3f> points{{0.1F, 0.1F, 0.1F}, {-0.1F, 0.1F, 0.1F}, {-0.1F, -0.1F, -0.1F}};
  EXPECT_EQ(voxel_downsample(points, 1), points);
}

TEST(ThinByVoxels, OfNoPointsThereAreNone) {
  EXPECT_TRUE(voxel_downsample({}, 0.5).empty());
  EXPECT_TRUE(voxel_first({}, 0.5).empty());
}

TEST(FirstPerVoxel, KeepsTheFirstSurfelOfEveryCell) {
  const double cell_m = 0.75;
  std::vector<Surfel> surfels;
  std::map<CellIndex, std::size_t> first;
  std::vector<std::size_t> expected;
  for (const Eigen::Vector3f& point : points_about({0, -2, 0}, 4, 3000, 4)) {
    if (first.try_emplace(cell_of(point, cell_m), surfels.size()).second) expected.push_back(surfels.size());
    surfels.push_back({point, static_cast<float>(surfels.size()) * Eigen::Matrix3f::Identity()});
  }
  const auto kept = voxel_first(surfels, cell_m);
  ASSERT_EQ(kept.size(), expected.size());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    ASSERT_EQ(kept[k].position, surfels[expected[k]].position);
    ASSERT_EQ(kept[k].covariance, surfels[expected[k]].covariance);
  }
}

}  // namespace
}  // namespace radioslam
