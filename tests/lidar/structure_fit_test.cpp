#include "radioslam/lidar/structure_fit.hpp"

#include <gtest/gtest.h>

#include "lidar/scanned_room.hpp"
#include "radioslam/lidar/submap.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kFinePoints_m = 0.25, kLossScale = 2;

Surfel surfel_at(const Eigen::Vector3f& position, const Eigen::Vector3f& variances,
                 SurfelShape shape = SurfelShape::kSurface) {
  Surfel surfel;
  surfel.position = position;
  surfel.covariance = variances.asDiagonal();
  surfel.shape = shape;
  return surfel;
}

ScanPyramid scan_of(const std::vector<Surfel>& surfels) {
  ScanPyramid scan;
  scan.all = scan.source.surfels = scan.few.surfels = surfels;
  return scan;
}

Submap map_of(const ScanPyramid& scan) {
  LocalMap map(kFinePoints_m, {});
  map.add(scan, SE3(), 0);
  return Submap(map);
}

const Eigen::Vector3f kLevel{9, 9, 1e-4F}, kWall{1e-4F, 9, 9}, kNoPlane{0.01F, 0.01F, 0.01F};

TEST(Structure, IsTheShareOfInformationOnThePositionInThePlane) {
  EXPECT_NEAR(structure_of(scan_of({surfel_at({1, 2, 3}, kNoPlane)})), 2.0 / 3, 1e-6);
  EXPECT_NEAR(structure_of(scan_of({surfel_at({1, 2, 3}, kWall)})), 1, 1e-4);
  EXPECT_NEAR(structure_of(scan_of({surfel_at({1, 2, 3}, kLevel)})), 0, 1e-4);
  EXPECT_EQ(structure_of(scan_of({surfel_at({1, 2, 3}, kWall, SurfelShape::kIsolated)})), 0) << "no normal";
  EXPECT_EQ(structure_of({}), 0);
}

/// One correspondence at the distance d: (s^2 / (s^2 + d^2 / 2 c))^2, c: the variance of either surfel.
TEST(StructureFit, OfOneSurfelIsItsRobustWeight) {
  const ScanPyramid scan = scan_of({surfel_at({1, 2, 3}, kNoPlane)});
  const Submap map = map_of(scan);
  for (const double off_m : {0.0, 0.1, 0.3}) {
    const double root = 4 / (4 + off_m * off_m / 0.02);
    EXPECT_NEAR(structure_fit(map.fine(), scan, pose_at(off_m, 0, 0, 0), ScannerKind::kSpatial, kLossScale),
                root * root, 1e-5);
  }
  EXPECT_EQ(structure_fit(map.fine(), scan, pose_at(50, 0, 0, 0), ScannerKind::kSpatial, kLossScale), 0);
  EXPECT_EQ(structure_fit(map.fine(), {}, SE3(), ScannerKind::kSpatial, kLossScale), 0);
}

/// A wall of the scan that has no counterpart lowers the fit by its share; ground without one does not.
TEST(StructureFit, DoesNotCountTheGround) {
  const Surfel wall = surfel_at({1, 2, 3}, kWall), other = surfel_at({1, 20, 3}, kWall),
               ground = surfel_at({5, 20, 0}, kLevel);
  const Submap map = map_of(scan_of({wall}));
  const auto fit = [&](const std::vector<Surfel>& surfels) {
    return structure_fit(map.fine(), scan_of(surfels), SE3(), ScannerKind::kSpatial, kLossScale);
  };
  EXPECT_NEAR(fit({wall}), 1, 1e-3);
  EXPECT_NEAR(fit({wall, ground}), 1, 1e-3);
  EXPECT_NEAR(fit({wall, other}), 0.5, 1e-3);
  EXPECT_NEAR(fit({ground}), 0, 1e-3);
}

/// Of a planar scanner every surfel is one of a wall, with a normal or without.
TEST(StructureFit, CountsEverySurfelOfAPlanarScanner) {
  const Surfel wall = surfel_at({1, 2, 0}, kWall),
               single = surfel_at({5, 2, 0}, kNoPlane, SurfelShape::kIsolated);
  const Submap map = map_of(scan_of({wall}));
  EXPECT_NEAR(structure_fit(map.fine(), scan_of({wall, single}), SE3(), ScannerKind::kPlanar, kLossScale),
              0.5, 1e-6);
  EXPECT_NEAR(structure_fit(map.fine(), scan_of({wall, single}), SE3(), ScannerKind::kSpatial, kLossScale), 1,
              1e-3);
}

/// Around a hut in a field: most of a scan is ground, which fits anywhere.
TEST(StructureFit, OnAFieldFitsAtTheTruePoseOnly) {
  ScannedRoom field;
  field.boxes = {{{-300, -300, 0}, {300, 300, 60}}, {{3, -2, 0}, {6, 2, 4}}, {{-7, 3, 0}, {-5, 4, 3}}};
  Rng rng(3);
  Scanner scanner;
  scanner.azimuths = 240;
  const SE3 truth = pose_at(0.2, 0.1, 1.2, 0.05);
  const Submap map = map_of(
      pyramid_of(sweep(field, scanner, pose_at(0, 0, 1.2, 0), rng), kFinePoints_m, ScannerKind::kSpatial));
  const ScanPyramid scan =
      pyramid_of(sweep(field, scanner, truth, rng), kFinePoints_m, ScannerKind::kSpatial);
  const SE3 T_map_scan = pose_at(0, 0, 1.2, 0).inverse() * truth;
  const auto fit = [&](const SE3& off) {
    return structure_fit(map.fine(), scan, T_map_scan * off, ScannerKind::kSpatial, kLossScale);
  };
  EXPECT_LT(structure_of(scan), 0.5 * static_cast<double>(scan.source.surfels.size()));
  EXPECT_GT(fit(SE3()), 0.7);
  for (const SE3& off : {pose_at(2, 0, 0, 0), pose_at(0, -3, 0, 0), pose_at(0, 0, 0, 1.5)})
    EXPECT_LT(fit(off), 0.5 * fit(SE3()));
}

}  // namespace
}  // namespace radioslam
