// Mutual bearings between two robots: by hand, by sampling, and from a mission.
#include "radioslam/joint/aoa/mutual_bearing_constraints.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(RelativePose, OfTwoAnglesAndARangeByHand) {
  // b is 10 m to the left of a; it looks back towards a's front and sees a half right of its heading.
  const SE2 T = relative_pose({10, 1, kPi / 2, 1, -kPi / 4, 1});
  EXPECT_LT((T.translation() - Eigen::Vector2d(0, 10)).norm(), 1e-12);
  EXPECT_NEAR(T.angle(), -kPi / 4, 1e-12);
}

TEST(RelativePose, IsRecoveredFromWhatItPredicts) {
  Rng rng(1);
  for (int k = 0; k < 100; ++k) {
    const SE2 truth({rng.uniform(-50, 50), rng.uniform(-50, 50)}, rng.uniform(-kPi, kPi));
    const Eigen::Vector2d b = truth.translation(), a = truth.inverse().translation();
    const SE2 T = relative_pose({b.norm(), 1, std::atan2(b.y(), b.x()), 1, std::atan2(a.y(), a.x()), 1});
    EXPECT_LT((T.inverse() * truth).log().norm(), 1e-9);
  }
}

/// Covariance of b's position in b's own axes, and of its heading, over noisy measurements.
Eigen::Matrix3d sampled_covariance(const MutualBearing& exact, int samples, std::uint64_t seed) {
  Rng rng(seed);
  const SE2 middle = relative_pose(exact);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (int k = 0; k < samples; ++k) {
    MutualBearing noisy = exact;
    noisy.range_m += rng.normal(0, exact.sigma_range_m);
    noisy.phi_rad += rng.normal(0, exact.sigma_phi_rad);
    noisy.psi_rad += rng.normal(0, exact.sigma_psi_rad);
    const SE2 error = middle.inverse() * relative_pose(noisy);
    const Eigen::Vector3d xi(error.translation().x(), error.translation().y(), error.angle());
    sum += xi;
    squares += xi * xi.transpose();
  }
  return squares / samples - sum / samples * (sum / samples).transpose();
}

TEST(RelativePose, ItsCovarianceIsThatOfSamples) {
  const MutualBearing measured{80, 0.5, 0.7, 0.05, -2.1, 0.08};
  const SE2::Jacobian expected = sampled_covariance(measured, 20000, 2);
  const SE2::Jacobian covariance = relative_pose_covariance(measured);
  EXPECT_LT((covariance - expected).norm(), 0.03 * expected.norm());
  // Whitened, so that the small entries count as well.
  const SE2::Jacobian root = expected.llt().matrixL();
  const SE2::Jacobian whitened = root.inverse() * covariance * root.inverse().transpose();
  EXPECT_LT((whitened - SE2::Jacobian::Identity()).norm(), 0.1);
}

TEST(RelativePose, ItsCurvatureCountsAlongTheLineOfSight) {
  const double sigma = 10 * kPi / 180;
  const MutualBearing measured{100, 0.5, 0, sigma, kPi, 1e-3};  // b looks along a's heading
  const double along = std::sqrt(relative_pose_covariance(measured)(0, 0));
  EXPECT_NEAR(along, 2.2, 0.05) << "0.5 m of the range and 2.15 m of the arc";
  EXPECT_NEAR(along / std::sqrt(sampled_covariance(measured, 20000, 3)(0, 0)), 1, 0.05);
}

/// Two robots that drive straight, b from 40 m left of a's start, back towards it; a range at 5.5 s and
/// angles at both ends shortly after.
Mission two_robots(double angle_delay_s) {
  Mission mission;
  mission.robots.resize(2);
  for (std::size_t r = 0; r < 2; ++r) {
    std::vector<StampedPose<SE3>> rows;
    for (int k = 0; k <= 12; ++k) rows.push_back({Stamp::from_seconds(k), lift(SE2({2.0 * k, 0}, 0))});
    mission.robots[r].id = r == 0 ? "a" : "b";
    mission.robots[r].odometry = Trajectory<SE3>(std::move(rows));
  }
  const LinkEnd a{RobotIndex(0), {}, {}, Eigen::Vector3d::Zero()};
  const LinkEnd b{RobotIndex(1), {}, {}, Eigen::Vector3d::Zero()};
  const Stamp at = Stamp::from_seconds(5.5), later = Stamp::from_seconds(5.5 + angle_delay_s);
  mission.ranges.push_back({at, b, a, 40, 0.5});              // listed by the second robot
  const double azimuth = std::atan2(40, -4 * angle_delay_s);  // by then each has passed the other
  mission.aoa_measurements.push_back(
      {later, RobotIndex(0), b, {{azimuth, {}, 0.1, -50}, {0.3, {}, 0.1, -60}}});
  mission.aoa_measurements.push_back({later, RobotIndex(1), a, {{azimuth, {}, 0.1, -50}}});
  return mission;
}

/// As the alignment leaves it: the first path of every angle is direct.
JointGraph<SE2> aligned(const Mission& mission) {
  auto joint = build_joint_graph<SE2>(mission, {}, {});
  for (const auto& bearing : joint.team.bearings)
    for (std::size_t p = 0; p < bearing.paths.size(); ++p)
      joint.team.graph.bearings.emplace_back(path_factor(bearing, p)).weight = p == 0 ? 0.9 : 0.1;
  return joint;
}

TEST(MutualBearings, ARangeWithAnglesAtBothEndsIsALink) {
  for (const double delay_s : {0.0, 0.3}) {
    const auto joint = aligned(two_robots(delay_s));
    const auto [links, is_estimated] = measured_links(joint, 0.5, 100);
    EXPECT_FALSE(is_estimated);
    const auto view = links.team().view(0, 1);
    ASSERT_EQ(view.ties(), 1U);
    // At 5.5 s each is 40 m to the left of the other: opposite headings. Keyframes are 2 m apart.
    const auto& a = links.poses(0).records();
    const auto& b = links.poses(1).records();
    ASSERT_EQ(a.size(), 13U);
    const auto place = view.relative(0, a[5], b[5]);
    EXPECT_LT((place.difference_m - Eigen::Vector2d(2, 40)).norm(), 1e-9);
    EXPECT_NEAR(wrap_angle(view.turn_in_a(0) - kPi), 0, 1e-9);
    // 40 m at 0.1 rad, and less than half a metre of odometry: the link's own errors.
    EXPECT_NEAR(std::sqrt(place.covariance(0, 0)), 4, 0.3);
    EXPECT_NEAR(std::sqrt(place.covariance(1, 1)), 0.6, 0.2);
    EXPECT_GT(view.relative(0, a[0], b[5]).covariance(0, 0) + view.relative(0, a[0], b[5]).covariance(1, 1),
              place.covariance(0, 0) + place.covariance(1, 1))
        << "further from the link";
  }
}

TEST(MutualBearings, AnglesOfAnotherTimeDoNotCount) {
  const auto joint = aligned(two_robots(0.3));
  // Then the joint estimate's relative poses are used instead: 12 m of odometry each, no angle in the link.
  const auto [estimated, is_estimated] = measured_links(joint, 0.2, 100);
  EXPECT_TRUE(is_estimated);
  ASSERT_EQ(estimated.team().view(0, 1).ties(), 1U);
  EXPECT_GT(std::abs(estimated.team().view(0, 1).turn_in_a(0) - kPi), 1)
      << "the graph's poses are not aligned here";
}

TEST(MutualBearings, ThoseAfterOneKeyframeAreToldApart) {
  Mission mission = two_robots(0);
  for (std::size_t k = 0; k < 2; ++k) {  // from .3 s later, of a reflection that is taken for direct
    AoaMeasurement later = mission.aoa_measurements[2 * k];
    later.stamp = Stamp::from_seconds(5.8);
    later.paths = {{0.2, {}, 0.1, -50}};
    mission.aoa_measurements.insert(mission.aoa_measurements.begin(), later);
  }
  const auto [links, is_estimated] = measured_links(aligned(mission), 0.5, 100);
  EXPECT_FALSE(is_estimated);
  const auto view = links.team().view(0, 1);
  ASSERT_EQ(view.ties(), 1U);
  const auto place = view.relative(0, links.poses(0).records()[5], links.poses(1).records()[5]);
  EXPECT_LT((place.difference_m - Eigen::Vector2d(2, 40)).norm(), 1e-9);
}

TEST(MutualBearings, AnEstimatedLinkCountsOnceForAllRangesOfItsPoses) {
  Mission mission = two_robots(0.3);
  mission.ranges.push_back(mission.ranges[0]);
  mission.ranges.back().stamp = Stamp::from_seconds(5.7);
  EXPECT_EQ(measured_links(aligned(mission), 0.01, 100).covariance.team().view(0, 1).ties(), 1U);
}

TEST(MutualBearings, MoreThanAskedForAreThinnedEvenly) {
  Mission mission = two_robots(0);
  const auto range = mission.ranges[0];
  const auto aoa_measurements = mission.aoa_measurements;
  for (int k = 1; k < 20; ++k) {
    const Stamp at = Stamp::from_seconds(1 + 0.5 * k + 0.05);
    mission.ranges.push_back(range);
    mission.ranges.back().stamp = at;
    for (auto aoa : aoa_measurements) {
      aoa.stamp = at;
      mission.aoa_measurements.push_back(aoa);
    }
  }
  const auto joint = aligned(mission);
  EXPECT_EQ(measured_links(joint, 0.01, 100).covariance.team().view(0, 1).ties(), 20U);
  EXPECT_EQ(measured_links(joint, 0.01, 7).covariance.team().view(0, 1).ties(), 7U);
}

}  // namespace
}  // namespace radioslam
