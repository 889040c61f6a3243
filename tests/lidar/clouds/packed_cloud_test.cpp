#include "radioslam/lidar/clouds/packed_cloud.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "lidar/scanned_room.hpp"

namespace radioslam {
namespace {

using namespace test;

ScanPyramid scan_of(ScannerKind kind) {
  Rng rng(7);
  const Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
  return pyramid_of(sweep(furnished_room(), scanner, pose_at(-1, 0.3, 1.2, 0.4), rng), 0.1, kind);
}

/// Standard deviation along a direction.
double sigma(const Surfel& surfel, const Eigen::Vector3f& along) {
  return std::sqrt(static_cast<double>(along.dot(surfel.covariance * along)));
}

void expect_alike(const Surfel& a, const Surfel& b) {
  EXPECT_LE((a.position - b.position).cwiseAbs().maxCoeff(), 0.5F / 256 + 1e-5F);
  EXPECT_EQ(a.shape, b.shape);
  EXPECT_NEAR(b.tilt_rad2, a.tilt_rad2, 0.055F * a.tilt_rad2);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes(a.covariance);
  EXPECT_NEAR(b.covariance.trace(), a.covariance.trace(), 0.06F * a.covariance.trace());
  EXPECT_NEAR(std::log(b.covariance.determinant()), std::log(a.covariance.determinant()), 0.16F);
  // Half a degree lets a long axis show across it.
  const double across_m = sigma(a, axes.eigenvectors().col(0)),
               along_m = sigma(a, axes.eigenvectors().col(2));
  EXPECT_NEAR(sigma(b, axes.eigenvectors().col(0)), across_m, 0.03 * across_m + 0.009 * along_m);
}

void expect_alike(const std::vector<Surfel>& a, const std::vector<Surfel>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) expect_alike(a[k], b[k]);
}

class PackedCloud : public ::testing::TestWithParam<ScannerKind> {};
INSTANTIATE_TEST_SUITE_P(Scanners, PackedCloud,
                         ::testing::Values(ScannerKind::kSpatial, ScannerKind::kPlanar));

TEST_P(PackedCloud, IsTheCloudToTwoMillimetresAndHalfADegree) {
  const ScanPyramid cloud = scan_of(GetParam());
  const ScanPyramid again = unpacked(packed(cloud));
  expect_alike(cloud.all, again.all);
  expect_alike(cloud.source.surfels, again.source.surfels);
  expect_alike(cloud.few.surfels, again.few.surfels);
  EXPECT_EQ(again.median_range_m, cloud.median_range_m);
  EXPECT_EQ(again.source.effective_sample_ratio, cloud.source.effective_sample_ratio);
  EXPECT_EQ(again.few.effective_sample_ratio, cloud.few.effective_sample_ratio);
}

TEST_P(PackedCloud, TakesAtMostEightBytesAPoint) {
  const ScanPyramid cloud = scan_of(GetParam());
  EXPECT_LE(packed(cloud).size(), 8 * cloud.all.size());
}

TEST_P(PackedCloud, DoesNotDriftWhenPackedAgain) {
  const ScanPyramid once = unpacked(packed(scan_of(GetParam())));
  const ScanPyramid twice = unpacked(packed(once));
  for (std::size_t k = 0; k < once.all.size(); ++k) {
    EXPECT_EQ(once.all[k].position, twice.all[k].position);
    EXPECT_EQ(once.all[k].tilt_rad2, twice.all[k].tilt_rad2);
  }
}

TEST(PackedCloudOfLargeOnes, KeepsFarPointsInWiderSteps) {
  ScanPyramid cloud;
  for (const float range_m : {0.0F, 1.0F, -900.0F})
    cloud.all.push_back({Eigen::Vector3f(range_m, 1, 2), Eigen::Matrix3f::Identity()});
  const ScanPyramid again = unpacked(packed(cloud));
  for (std::size_t k = 0; k < cloud.all.size(); ++k)
    EXPECT_LT((cloud.all[k].position - again.all[k].position).norm(), 0.03F);
}

TEST(PackedCloudOfNothing, IsEmpty) { EXPECT_TRUE(unpacked(packed({})).all.empty()); }

TEST(PackedCloudOfLevelLines, StaysExactlyLevel) {
  ScanPyramid cloud;
  cloud.all.push_back(
      {Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(9, 9, 4e-4F).asDiagonal(), 0.04F, SurfelShape::kScanLine});
  const Eigen::Matrix3f covariance = unpacked(packed(cloud)).all[0].covariance;
  EXPECT_NEAR(covariance(2, 2), 4e-4F, 3e-5F);
}

}  // namespace
}  // namespace radioslam
