#include "radioslam/places/scan_context.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "places/compare_by_shifts.hpp"
#include "places/random_grids.hpp"
#include "places/scanned_town.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kTurn = 2 * std::numbers::pi;

ScanContext heights(const std::vector<Eigen::Vector3f>& points, double max_range_m) {
  return make_scan_context(points, max_range_m, ScanContextKind::kHeight, {});
}

Eigen::Vector3f at(double range_m, double azimuth_rad, double z_m) {
  return Eigen::Vector3d(range_m * std::cos(azimuth_rad), range_m * std::sin(azimuth_rad), z_m).cast<float>();
}

std::vector<Eigen::Vector3f> turned(const std::vector<Eigen::Vector3f>& points, double yaw_rad,
                                    double up_m = 0) {
  std::vector<Eigen::Vector3f> result;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p = point.cast<double>();
    result.push_back(at(p.head<2>().norm(), std::atan2(p.y(), p.x()) + yaw_rad, p.z() + up_m));
  }
  return result;
}

double angle_between(double a_rad, double b_rad) { return std::abs(std::remainder(a_rad - b_rad, kTurn)); }

TEST(ScanContext, HasTheGreatestHeightAboveTheGroundOfEachBin) {
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 95; ++k) points.push_back(at(0.5, 1e-3 * k, -1.5));  // the ground: ring 0, sector 0
  points.push_back(at(5.5, kTurn / 4 + 0.01, 0.5));
  points.push_back(at(5.5, kTurn / 4 + 0.01, 2.5));
  points.push_back(at(19.5, -0.01, 8));
  const ScanContext context = heights(points, 20);
  ASSERT_EQ(context.rings(), 20);
  ASSERT_EQ(context.sectors(), 60);
  EXPECT_NEAR(context.bins()(5, 15), 4, 2e-4);
  EXPECT_FLOAT_EQ(context.bins()(19, 59), 9.5);
  EXPECT_NEAR(context.bins().sum(), 13.5, 2e-4);  // on the ground the height is 0
  EXPECT_EQ(context.columns(), std::uint64_t{1} << 15 | std::uint64_t{1} << 59);
}

TEST(ScanContext, DoesNotDependOnTheScannersHeightNorOnItsLowestOutliers) {
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 200; ++k) points.push_back(at(1 + 0.05 * k, 0.2 * k, k < 100 ? 0 : 0.02 * k));
  const Eigen::MatrixXf bins = heights(points, 12).bins();
  EXPECT_TRUE(heights(turned(points, 0, 0.75), 12).bins().isApprox(bins, 1e-4F));
  for (int k = 0; k < 5; ++k) points.push_back(at(3, k, -4));
  EXPECT_TRUE(heights(points, 12).bins().isApprox(bins, 1e-4F));
}

TEST(ScanContext, OfAPlanarScannerHasOccupiedBins) {
  const auto context = make_scan_context({at(3.5, 0.01, 0), at(3.6, 0.02, 0), at(7.5, kTurn / 2 + 0.01, 0)},
                                         20, ScanContextKind::kOccupancy, {});
  EXPECT_EQ(context.bins()(3, 0), 1);
  EXPECT_EQ(context.bins()(7, 30), 1);
  EXPECT_EQ(context.bins().sum(), 2);
}

TEST(ScanContext, IgnoresPointsOutOfRangeAtTheOriginOrNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto context = make_scan_context({{0, 0, 0}, {0, 0, 1}, {nan, 1, 0}, {1, 0, nan}, at(20.01, 0, 0)},
                                         20, ScanContextKind::kOccupancy, {});
  EXPECT_TRUE(context.empty());
  EXPECT_TRUE(context.bins().isZero(0));
}

TEST(ScanContext, OfNothingHasDistanceOneToEverything) {
  Rng rng(1);
  const ScanContext nothing = heights({}, 20), other = random_context(20, 60, 0, rng);
  EXPECT_TRUE(nothing.empty());
  for (const ContextMatch& match :
       {compare(nothing, other), compare(other, nothing), compare(nothing, nothing)}) {
    EXPECT_EQ(match.distance, 1);
    EXPECT_EQ(match.yaw_rad, 0);
  }
}

TEST(ScanContext, ComparesLikeTheShiftsOneByOne) {
  Rng rng(2);
  for (int k = 0; k < 300; ++k) {
    const int rings = k % 3 == 0 ? 64 : 1 + static_cast<int>(rng.below(40));
    const int sectors = k % 2 == 0 ? 60 : 4 + static_cast<int>(rng.below(61));
    const double empty_columns = k % 5 == 0 ? 0 : rng.uniform(0, 0.9);
    const ScanContext a = random_context(rings, sectors, empty_columns, rng);
    const ScanContext b = random_context(rings, sectors, empty_columns, rng);
    const ContextMatch match = compare(a, b);
    const auto distances = distances_by_shifts(a, b);
    EXPECT_NEAR(match.distance, distance_by_shifts(a, b), 1e-4);
    EXPECT_NEAR(match.distance, distances[static_cast<std::size_t>(match.shift)], 1e-4);
    EXPECT_NEAR(compare(b, a).distance, match.distance, 1e-5);
  }
}

TEST(ScanContext, FindsAShiftByWholeSectors) {
  Rng rng(3);
  for (const int sectors : {7, 59, 60, 64}) {
    const Eigen::MatrixXf bins = random_bins(20, sectors, 0.4, 0.2, rng);
    const ScanContext b(bins, 0.25);
    for (int shift = 0; shift < sectors; ++shift) {
      const ContextMatch match = compare(ScanContext(shifted(bins, shift), 0.25), b);
      EXPECT_NEAR(match.distance, 0, 1e-4);
      EXPECT_EQ(match.shift, shift);
      EXPECT_NEAR(angle_between(match.yaw_rad, kTurn * shift / sectors), 0, 1e-9);
      EXPECT_GT(match.yaw_rad, -kTurn / 2 - 1e-9);
      EXPECT_LE(match.yaw_rad, kTurn / 2);
    }
  }
}

TEST(ScanContext, YawTurnsPointsOfTheSecondScanIntoTheFirst) {
  Rng rng(4);
  const Town town = random_town(4, rng);
  for (const TownPose& place : drive(town, 20, 5, rng)) {
    const auto points = scan_town(town, place, {}, rng);
    const ScanContext a = heights(points, 80);
    const double yaw_rad = rng.uniform(-kTurn / 2, kTurn / 2);
    const ContextMatch match = compare(a, heights(turned(points, -yaw_rad), 80));  // p_a = Rz(yaw) p_b
    EXPECT_LE(angle_between(match.yaw_rad, yaw_rad), 0.6 * kTurn / 60);
    EXPECT_LT(match.distance, 0.3);
    TownPose other = place;
    other.yaw_rad += yaw_rad;
    const ContextMatch scanned = compare(a, heights(scan_town(town, other, {}, rng), 80));
    EXPECT_LE(angle_between(scanned.yaw_rad, yaw_rad), kTurn / 60);
  }
}

TEST(ScanContext, DoesNotConsiderShiftsWithFewCommonColumns) {
  Eigen::MatrixXf bins = Eigen::MatrixXf::Zero(4, 60);
  bins.leftCols(14).setOnes();
  EXPECT_EQ(compare(ScanContext(bins, 0.25), ScanContext(bins, 0.25)).distance, 1);
  bins.leftCols(15).setOnes();
  EXPECT_NEAR(compare(ScanContext(bins, 0.25), ScanContext(bins, 0.25)).distance, 0, 1e-4);
  EXPECT_EQ(compare(ScanContext(bins, 0.25), ScanContext(bins, 0.3)).distance, 1);
}

TEST(ScanContext, IsSentAsAByteForEachBin) {
  const ScanContext context = heights({}, 20);
  EXPECT_GE(wire_bytes(context), 1200U);
  EXPECT_LE(wire_bytes(context), 1220U);
}

}  // namespace
}  // namespace radioslam
