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

/// Rings of points around a robot that goes straight on, in a store of so many mebibytes.
ScanKeyframes ringed_keyframes(int memory_mib) {
  CloudStore store({memory_mib});
  ScanKeyframes keyframes;
  for (int k = 0; k < 20; ++k) {
    ScanPyramid cloud;
    for (int n = 0; n < 2000; ++n) {
      const float angle = 0.01F * static_cast<float>(n), range_m = 4 + 0.2F * static_cast<float>(k);
      cloud.all.push_back(
          {Eigen::Vector3f(range_m * std::cos(angle), range_m * std::sin(angle), 0.1F * angle),
           Eigen::Matrix3f::Identity()});
    }
    keyframes.clouds.push_back(store.add(cloud));
    keyframes.poses.push_back(pose_at(k, 0, 0, 0));
  }
  return keyframes;
}

TEST(KeyframeContexts, AreTheSameOfCloudsInMemoryAndOnDisk) {
  const ScanKeyframes in_memory = ringed_keyframes(64), on_disk = ringed_keyframes(0);
  const double range_m = context_range(in_memory);
  EXPECT_NEAR(range_m, 7.4, 0.3);
  EXPECT_EQ(context_range(on_disk), range_m);
  const auto path_m = path_lengths(in_memory);
  const auto a = keyframe_contexts(in_memory, path_m, range_m, 5, {});
  const auto b = keyframe_contexts(on_disk, path_m, range_m, 5, {});
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].bins(), b[k].bins());
}

}  // namespace
}  // namespace radioslam
