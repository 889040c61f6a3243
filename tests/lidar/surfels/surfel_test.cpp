#include "radioslam/lidar/surfels/surfel.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

constexpr double kSpacing_m = 0.1;

Eigen::Quaterniond random_turn(Rng& rng) {
  const double w = rng.normal(), x = rng.normal(), y = rng.normal(), z = rng.normal();
  return Eigen::Quaterniond(w, x, y, z).normalized();
}

/// A square of points, a spacing apart and jittered, with this noise across.
std::vector<Eigen::Vector3f> noisy_plane(const Eigen::Vector3d& centre, const Eigen::Quaterniond& turn,
                                         double sigma_m, Rng& rng) {
  std::vector<Eigen::Vector3f> points;
  for (int a = -10; a <= 10; ++a)
    for (int b = -10; b <= 10; ++b) {
      const double u = kSpacing_m * (a + rng.uniform(-0.3, 0.3));
      const double v = kSpacing_m * (b + rng.uniform(-0.3, 0.3));
      const Eigen::Vector3d point = turn * Eigen::Vector3d(u, v, rng.normal(0, sigma_m));
      points.emplace_back((centre + point).cast<float>());
    }
  return points;
}

Eigen::Vector3d thinnest_direction(const Surfel& surfel) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(surfel.covariance.cast<double>())
      .eigenvectors()
      .col(0);
}

bool is_positive_definite(const Eigen::Matrix3f& covariance) {
  return covariance.allFinite() && covariance.isApprox(covariance.transpose()) &&
         covariance.cast<double>().eigenvalues().real().minCoeff() > 0;
}

TEST(MeasureSurfels, AreThinAcrossAPlaneAndWideAlongIt) {
  Rng rng(1);
  const double sigma_m = 0.01;
  SurfelParams params;
  params.sigma_range_m = 0.004;
  for (int n = 0; n < 20; ++n) {
    const Eigen::Quaterniond turn = random_turn(rng);
    const Eigen::Vector3d normal = turn * Eigen::Vector3d::UnitZ(), along = turn * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d centre = turn * Eigen::Vector3d(0, 3, n == 0 ? 1000 : 10);
    const auto points = noisy_plane(centre, turn, sigma_m, rng);
    std::vector<double> across, wide, aligned;  // at an edge the neighbourhood is one-sided
    for (const Surfel& surfel : measure_surfels(points, kSpacing_m, ScannerKind::kSpatial, params)) {
      const Eigen::Matrix3d covariance = surfel.covariance.cast<double>();
      across.push_back(1 / normal.dot(covariance.inverse() * normal));
      wide.push_back(along.dot(covariance * along));
      aligned.push_back(std::abs(thinnest_direction(surfel).dot(normal)));
    }
    EXPECT_GT(upper_median(wide), std::pow(kSpacing_m / 2, 2));
    EXPECT_GT(upper_median(aligned), 0.98);
    const double noise = sigma_m * sigma_m + params.sigma_range_m * params.sigma_range_m;
    EXPECT_GT(upper_median(across), 0.7 * noise);
    EXPECT_LT(upper_median(across), 2 * noise);
  }
}

TEST(MeasureSurfels, AreLocatedAtTheirPoints) {
  Rng rng(2);
  const auto points = noisy_plane({1, 2, 3}, random_turn(rng), 0.01, rng);
  const auto surfels = measure_surfels(points, kSpacing_m, ScannerKind::kSpatial, {});
  ASSERT_EQ(surfels.size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k) ASSERT_EQ(surfels[k].position, points[k]);
}

TEST(MeasureSurfels, OfAPlanarScannerLeaveTheHeightOpen) {
  std::vector<Eigen::Vector3f> wall;
  for (int k = 0; k < 50; ++k) wall.emplace_back(2.0F, 0.1F * static_cast<float>(k), 0.0F);
  const auto surfels = measure_surfels(wall, kSpacing_m, ScannerKind::kPlanar, {});
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    const Surfel& surfel = surfels[k];
    EXPECT_GE(surfel.covariance(2, 2), kSpacing_m * kSpacing_m);
    if (k < 3 || k + 3 >= surfels.size()) continue;  // few neighbours at a wall's end
    EXPECT_LT(surfel.covariance(0, 0), 0.1 * kSpacing_m * kSpacing_m);
    EXPECT_GT(surfel.covariance(1, 1), 0.25 * kSpacing_m * kSpacing_m);
  }
}

/// Without a known surface the covariance is the measurement's alone: for points far apart, or on one beam's
/// line along a wall.
TEST(MeasureSurfels, OfPointsWithoutASurfaceAreTheMeasurementsAlone) {
  std::vector<Eigen::Vector3f> apart, beam;
  for (int k = 0; k < 20; ++k) {
    apart.emplace_back(static_cast<float>(k), 0.0F, 0.0F);
    beam.emplace_back(5 + 0.05F * static_cast<float>(k), 1.0F, 0.0F);
  }
  const SurfelParams params;
  const auto variance = static_cast<float>(params.sigma_range_m * params.sigma_range_m);
  for (const auto& points : {apart, beam})
    for (const Surfel& surfel : measure_surfels(points, kSpacing_m, ScannerKind::kSpatial, params)) {
      EXPECT_EQ(surfel.shape, SurfelShape::kIsolated);
      EXPECT_TRUE(surfel.covariance.isApprox(variance * Eigen::Matrix3f::Identity()));
    }
}

/// One beam's line on the ground ahead, with range noise, constrains height alone.
TEST(MeasureSurfels, OfABeamOnTheGroundConstrainHeightOnly) {
  const SurfelParams params;
  const auto along = static_cast<float>(params.sigma_along_m * params.sigma_along_m);
  const auto height = static_cast<float>(params.sigma_range_m * params.sigma_range_m);
  Rng rng(6);
  std::vector<Eigen::Vector3f> beam;
  for (int k = -20; k < 20; ++k) {
    const double azimuth = 0.01 * k, range_m = 8 + rng.normal(0, params.sigma_range_m);
    beam.emplace_back(
        Eigen::Vector3d(range_m * std::cos(azimuth), range_m * std::sin(azimuth), -0.15 * range_m)
            .cast<float>());
  }
  for (const Surfel& surfel : measure_surfels(beam, kSpacing_m, ScannerKind::kSpatial, params)) {
    if (std::abs(surfel.position.y()) > 1) continue;  // few neighbours at its ends
    EXPECT_EQ(surfel.shape, SurfelShape::kScanLine);
    EXPECT_TRUE(
        surfel.covariance.isApprox(Eigen::Matrix3f(Eigen::Vector3f(along, along, height).asDiagonal())));
  }
}

/// A densely sampled wall ahead, whose neighbourhoods are little wider than the noise: none is taken for a
/// scan line on the ground.
TEST(MeasureSurfels, OfADenseWallAreNoScanLines) {
  const double spacing_m = 0.07;
  const SurfelParams params;
  Rng rng(7);
  std::vector<Eigen::Vector3f> wall;
  for (int y = -20; y <= 20; ++y)
    for (int z = -20; z <= 20; ++z) {
      const double beside_m = spacing_m * (y + rng.uniform(-0.3, 0.3));
      const double above_m = spacing_m * (z + rng.uniform(-0.3, 0.3));
      wall.emplace_back(
          Eigen::Vector3d(8 + rng.normal(0, params.sigma_range_m), beside_m, above_m).cast<float>());
    }
  for (const Surfel& surfel : measure_surfels(wall, spacing_m, ScannerKind::kSpatial, params))
    EXPECT_NE(surfel.shape, SurfelShape::kScanLine);
}

/// Three points of one beam and three of the next are never a certain surface, whatever their arrangement.
TEST(MeasureSurfels, OfFewNeighboursAreNoClearSurfaces) {
  const SurfelParams params;
  for (const int columns : {3, 4, 5}) {
    std::vector<Eigen::Vector3f> patch;
    for (int k = 0; k < columns; ++k)
      for (const float height : {0.0F, 0.2F}) patch.emplace_back(5.0F, 0.05F * static_cast<float>(k), height);
    for (const Surfel& surfel : measure_surfels(patch, kSpacing_m, ScannerKind::kSpatial, params))
      EXPECT_EQ(surfel.shape, columns == 3   ? SurfelShape::kIsolated
                              : columns == 4 ? SurfelShape::kUnstructured
                                             : SurfelShape::kSurface);
  }
}

/// The smallest permitted number of neighbours still yields surfaces.
TEST(MeasureSurfels, OfFewerNeighboursThanByDefaultAreSurfaces) {
  SurfelParams params;
  params.neighbours = 4;
  std::vector<Eigen::Vector3f> wall;
  for (int y = 0; y < 10; ++y)
    for (int z = 0; z < 10; ++z)
      wall.emplace_back(5.0F, 0.1F * static_cast<float>(y), 0.1F * static_cast<float>(z));
  for (const Surfel& surfel : measure_surfels(wall, kSpacing_m, ScannerKind::kSpatial, params))
    EXPECT_NE(surfel.shape, SurfelShape::kIsolated);
}

/// A pole and a wall at a small angle to few beams cannot be distinguished.
TEST(MeasureSurfels, OfARisingLineAreNoSurfaces) {
  std::vector<Eigen::Vector3f> line;
  for (int k = 0; k < 20; ++k) line.emplace_back(5.0F, 1.0F, 0.05F * static_cast<float>(k));
  for (const Surfel& surfel : measure_surfels(line, kSpacing_m, ScannerKind::kSpatial, {}))
    EXPECT_EQ(surfel.shape, SurfelShape::kUnstructured);
}

/// The stated variance of the normals is right, up to the overstated noise across the plane.
TEST(MeasureSurfels, OfAPlaneStateTheVarianceOfTheirNormals) {
  Rng rng(4);
  SurfelParams params;
  params.sigma_range_m = 1e-3;
  const double sigma_m = 0.01;
  double leans = 0, stated = 0;
  std::size_t surfaces = 0, all = 0;
  for (int n = 0; n < 20; ++n) {
    const Eigen::Quaterniond turn = random_turn(rng);
    const Eigen::Vector3d along = turn * Eigen::Vector3d::UnitX();
    const auto points = noisy_plane(turn * Eigen::Vector3d(0, 3, 5), turn, sigma_m, rng);
    for (const Surfel& surfel : measure_surfels(points, kSpacing_m, ScannerKind::kSpatial, params)) {
      ++all;
      if (surfel.shape != SurfelShape::kSurface) continue;
      ++surfaces;
      leans += std::pow(thinnest_direction(surfel).dot(along), 2);
      stated += static_cast<double>(surfel.tilt_rad2);
    }
  }
  EXPECT_GT(static_cast<double>(surfaces), 0.9 * static_cast<double>(all));
  EXPECT_GT(stated, 0.7 * leans);
  EXPECT_LT(stated, 3 * leans);
}

TEST(MeasureSurfels, OfFewOrOfEqualPointsArePositiveDefinite) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (const std::size_t count : {1U, 2U, 3U, 4U, 5U, 30U})
      for (const float apart_m : {0.0F, 0.05F, 50.0F}) {
        std::vector<Eigen::Vector3f> points;
        for (std::size_t k = 0; k < count; ++k) points.emplace_back(5, apart_m * static_cast<float>(k), 0);
        const auto surfels = measure_surfels(points, kSpacing_m, kind, {});
        ASSERT_EQ(surfels.size(), count);
        for (const Surfel& surfel : surfels) EXPECT_TRUE(is_positive_definite(surfel.covariance));
      }
  EXPECT_TRUE(measure_surfels({}, kSpacing_m, ScannerKind::kSpatial, {}).empty());
}

TEST(MeasureSurfels, AreTheSameForAnyNumberOfThreads) {
  Rng rng(3);
  auto points = noisy_plane({1, 2, 3}, random_turn(rng), 0.05, rng);
  const auto more = noisy_plane({1, 2, 4}, random_turn(rng), 0.05, rng);
  points.insert(points.end(), more.begin(), more.end());
  set_thread_count(1);
  const auto alone = measure_surfels(points, kSpacing_m, ScannerKind::kSpatial, {});
  set_thread_count(3);
  const auto together = measure_surfels(points, kSpacing_m, ScannerKind::kSpatial, {});
  set_thread_count(0);
  for (std::size_t k = 0; k < points.size(); ++k) ASSERT_EQ(alone[k].covariance, together[k].covariance) << k;
}

}  // namespace
}  // namespace radioslam
