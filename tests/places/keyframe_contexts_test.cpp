#include "radioslam/places/keyframe_contexts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lidar/scanned_room.hpp"

namespace radioslam {
namespace {

using namespace test;

/// Three keyframes 3 m and 4 m apart, the second step a motion with this standard deviation of the heading.
ScanKeyframes keyframes_with(double sigma_yaw_rad) {
  ScanKeyframes keyframes;
  keyframes.poses = {pose_at(0, 0, 0, 0), pose_at(3, 0, 0, 1), pose_at(3, 4, 0, 2)};
  SE3::Jacobian covariance = SE3::Jacobian::Identity() * 1e-4;
  keyframes.step_covariances = {covariance, covariance};
  keyframes.step_covariances[1].diagonal() << 4, 9, 12, 0, 0, sigma_yaw_rad * sigma_yaw_rad;
  return keyframes;
}

TEST(PathLengths, OfAnUnknownMotionAreWhatItMayHaveBeen) {
  const std::vector<double> known_m = path_lengths(keyframes_with(0.5));
  ASSERT_EQ(known_m.size(), 3U);
  EXPECT_EQ(known_m[0], 0);
  EXPECT_NEAR(known_m[1], 3, 1e-12);
  EXPECT_NEAR(known_m[2], 7, 1e-12) << "uncertain, but its heading is known";
  const std::vector<double> unknown_m = path_lengths(keyframes_with(2));
  EXPECT_NEAR(unknown_m[1], 3, 1e-12);
  EXPECT_NEAR(unknown_m[2], 7 + 3 * 5, 1e-12) << "three standard deviations of 5 m";
  EXPECT_TRUE(path_lengths({}).empty());
}

TEST(OdometrySigma, GrowsWithTheStepsBetween) {
  ScanKeyframes keyframes = keyframes_with(0);
  for (SE3::Jacobian& covariance : keyframes.step_covariances) {
    covariance.setZero();
    covariance.diagonal().head<3>().setConstant(0.09);
  }
  const std::vector<double> path_m = path_lengths(keyframes);
  EXPECT_EQ(odometry_sigma_m(keyframes, path_m, 1, 1), 0);
  EXPECT_NEAR(odometry_sigma_m(keyframes, path_m, 0, 1), 0.3, 1e-12);
  EXPECT_NEAR(odometry_sigma_m(keyframes, path_m, 0, 2), 0.3 * std::sqrt(2), 1e-12);
  EXPECT_EQ(odometry_sigma_m(keyframes, path_m, 2, 0), odometry_sigma_m(keyframes, path_m, 0, 2));
  keyframes.step_covariances.clear();
  EXPECT_NEAR(odometry_sigma_m(keyframes, path_m, 0, 2), 0.02 * 7, 1e-12) << "2 % of the way";
}

}  // namespace
}  // namespace radioslam
