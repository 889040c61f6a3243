#include "radioslam/odometry/map_drift.hpp"

#include <gtest/gtest.h>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kScanSigma_m = 0.02, kScanSigma_rad = 0.001;

ScanPose scan_at(const SE3& T, double novelty_ratio) {
  ScanPose scan;
  scan.T_start_body = T;
  scan.status = ScanStatus::kRegistered;
  scan.novelty_ratio = novelty_ratio;
  scan.information.diagonal().head<3>().setConstant(1 / (kScanSigma_m * kScanSigma_m));
  scan.information.diagonal().tail<3>().setConstant(1 / (kScanSigma_rad * kScanSigma_rad));
  return scan;
}

SE3 metres_on(double x) { return SE3({x, 0, 0}, Eigen::Quaterniond::Identity()); }

SE3::Jacobian drift_along(const ScanPoses& scans) {
  MapDrift drift(scans.front(), {});
  for (std::size_t k = 1; k < scans.size(); ++k) drift.add(scans[k]);
  return drift.covariance();
}

TEST(MapDrift, IsNoneOverKnownGround) {
  ScanPoses scans;
  for (int k = 0; k < 100; ++k) scans.push_back(scan_at(metres_on(0.2 * k), 0));
  const SE3::Jacobian drift = drift_along(scans);
  EXPECT_LT(drift.diagonal().head<3>().cwiseSqrt().maxCoeff(), 1e-3);
  EXPECT_LT(drift.diagonal().tail<3>().cwiseSqrt().maxCoeff(), 1e-4);
  EXPECT_GT(drift.diagonal().minCoeff(), 0);
}

/// Monte Carlo of scans with registration errors on a map that each moves by its novelty ratio times its
/// error.
TEST(MapDrift, IsThatOfAMapThatItsScansMove) {
  constexpr double kRatio = 0.2;
  constexpr int kScans = 30, kRuns = 400;
  ScanPoses scans;
  for (int k = 0; k < kScans; ++k) {
    SE3::Tangent turn;
    turn << 0, 0, 0, 0, 0, 0.05 * k;
    scans.push_back(scan_at(metres_on(0.5 * k) * SE3::exp(turn), kRatio));
  }
  const SE3::Jacobian stated = drift_along(scans);
  Rng rng(1);
  double squares = 0;
  for (int run = 0; run < kRuns; ++run) {
    SE3 moved;  // drift of the map so far
    for (int k = 0; k + 1 < kScans; ++k) {
      SE3::Tangent error;
      for (int axis = 0; axis < 6; ++axis)
        error(axis) = kRatio * rng.normal(0, axis < 3 ? kScanSigma_m : kScanSigma_rad);
      const SE3& T = scans[static_cast<std::size_t>(k)].T_start_body;
      moved = moved * T * SE3::exp(error) * T.inverse();
    }
    const SE3 T_from = scans.front().T_start_body;
    const SE3::Tangent drift = (T_from.inverse() * moved * T_from).log();
    squares += drift.dot(stated.inverse() * drift) / 6;
  }
  EXPECT_NEAR(squares / kRuns, 1, 0.1);
}

/// If one scan has no information along the corridor, neither has the motion across it.
TEST(MapDrift, IsWideWhereOneScanSawNothing) {
  ScanPoses scans;
  for (int k = 0; k < 10; ++k) scans.push_back(scan_at(metres_on(0.2 * k), 0.1));
  EXPECT_LT(std::sqrt(drift_along(scans)(0, 0)), kScanSigma_m);
  scans[5].information(0, 0) = 0;
  const SE3::Jacobian drift = drift_along(scans);
  EXPECT_GT(std::sqrt(drift(0, 0)), 0.5);
  EXPECT_LT(std::sqrt(drift(1, 1)), kScanSigma_m);
}

TEST(MapDrift, OntoANewMapIsThatOfTheStepToIt) {
  ScanPoses scans{scan_at(metres_on(0), 0.1), scan_at(metres_on(3), 1)};
  scans[1].status = ScanStatus::kNewMap;
  scans[1].covariance = 4 * SE3::Jacobian::Identity();
  const SE3::Jacobian drift = drift_along(scans);
  EXPECT_NEAR(drift(0, 0), 4, 1e-6);
  EXPECT_NEAR(drift(1, 1), 4 + 4 * 9, 1e-6);  // rotated about a position three metres on
}

}  // namespace
}  // namespace radioslam
