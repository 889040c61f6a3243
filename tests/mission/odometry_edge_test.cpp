#include "radioslam/mission/odometry_edge.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {
namespace {

OdometryNoise noise() {
  OdometryNoise noise;
  noise.sigma_xy_per_sqrt_m = 0.02;
  noise.sigma_yaw_per_sqrt_m_rad = 0.003;
  noise.sigma_yaw_per_rad = 0.02;
  noise.sigma_z_per_sqrt_m = 0.01;
  return noise;
}

using Tangent = SE3::Tangent;

/// Trajectory composed of the increments Exp(increment(k)), one pose per second.
Trajectory<SE3> drive(int increments, const std::function<Tangent(int)>& increment) {
  std::vector<StampedPose<SE3>> rows{{Stamp{}, SE3()}};
  for (int k = 0; k < increments; ++k)
    rows.push_back({Stamp::from_seconds(k + 1), rows.back().pose * SE3::exp(increment(k))});
  return Trajectory<SE3>(std::move(rows));
}

/// A winding path; `slope` tilts it out of the plane.
Tangent winding(int k, double slope = 0) {
  Tangent xi;
  xi << 0.1, 0.01 * std::sin(0.3 * k), slope * std::cos(0.2 * k), slope * std::sin(0.1 * k), 0,
      0.03 * std::sin(0.07 * k) + 0.01;
  return xi;
}

template <class Pose>
void expect_cuts_agree(const Trajectory<SE3>& odometry) {
  const std::size_t end = odometry.size() - 1;
  const auto whole = odometry_edge<Pose>(odometry, 0, end, noise());
  const auto floor = odometry_edge<Pose>(odometry, 7, 7, noise()).covariance;
  for (const std::size_t cut : {std::size_t{1}, end / 3, end - 1}) {
    const auto first = odometry_edge<Pose>(odometry, 0, cut, noise());
    const auto second = odometry_edge<Pose>(odometry, cut, end, noise());
    const typename Pose::Jacobian carry = second.T_i_j.inverse().adjoint();
    const typename Pose::Jacobian covariance =
        carry * (first.covariance - floor) * carry.transpose() + second.covariance;
    EXPECT_LT((covariance - whole.covariance).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((carry * first.drift_jacobian + second.drift_jacobian - whole.drift_jacobian).norm(), 1e-9);
    EXPECT_LT(((first.T_i_j * second.T_i_j).inverse() * whole.T_i_j).log().norm(), 1e-9);
    EXPECT_NEAR(first.distance_m + second.distance_m, whole.distance_m, 1e-9);
  }
}

TEST(OdometryEdge, SplitAnywhereItIsTheSame) {
  expect_cuts_agree<SE2>(drive(300, [](int k) { return winding(k); }));
  expect_cuts_agree<SE3>(drive(300, [](int k) { return winding(k, 0.02); }));
}

TEST(OdometryEdge, ATurnInPartsIsAsUncertainAsTheWholeTurn) {
  for (const int parts : {1, 10, 100}) {
    const auto odometry = drive(parts, [&](int) -> Tangent { return Tangent::Unit(5) / parts; });
    const auto edge = odometry_edge<SE2>(odometry, 0, odometry.size() - 1, noise());
    EXPECT_NEAR(edge.covariance(2, 2), 0.02 * 0.02, 1e-7);
    EXPECT_NEAR(edge.covariance(0, 0), 0, 1e-5);
  }
}

/// Yaw noise s per root metre on a straight path of length L: variance s^2 L of yaw and s^2 L^3 / 3 across.
TEST(OdometryEdge, YawErrorsAlongAStraightPathDisplaceItsEnd) {
  const auto odometry = drive(1000, [](int) -> Tangent { return 0.05 * Tangent::Unit(0); });
  const auto edge = odometry_edge<SE2>(odometry, 0, 1000, noise());
  const double yaw = 0.003 * 0.003, xy = 0.02 * 0.02, length = 50;
  EXPECT_NEAR(edge.covariance(2, 2), yaw * length, 0.005 * yaw * length);
  EXPECT_NEAR(edge.covariance(1, 2), yaw * length * length / 2, 0.005 * yaw * length * length / 2);
  const double across = xy * length + yaw * length * length * length / 3;
  EXPECT_NEAR(edge.covariance(1, 1), across, 0.005 * across);
  EXPECT_NEAR(edge.covariance(0, 0), xy * length, 0.005 * xy * length);
  EXPECT_NEAR(edge.distance_m, length, 1e-9);
}

/// End pose of one drive with noise drawn per increment according to OdometryNoise.
SE2 noisy_end(const Trajectory<SE3>& odometry, Rng& rng) {
  const auto square = [](double x) { return x * x; };
  SE2 end;
  for (std::size_t i = 0; i + 1 < odometry.size(); ++i) {
    const SE2 step = flatten(odometry[i].pose).inverse() * flatten(odometry[i + 1].pose);
    const double distance_m = step.translation().norm(), turn = std::abs(step.angle());
    const double sigma_xy = 0.02 * std::sqrt(distance_m);
    const double sigma_yaw = std::sqrt(square(0.003) * distance_m + square(0.02) * turn);
    end = end * step * SE2::exp({rng.normal(0, sigma_xy), rng.normal(0, sigma_xy), rng.normal(0, sigma_yaw)});
  }
  return end;
}

TEST(OdometryEdge, CovarianceIsThatOfNoisyDrives) {
  constexpr int kDrives = 3000;
  const auto odometry = drive(200, [](int k) { return winding(k); });
  const auto edge = odometry_edge<SE2>(odometry, 0, 200, noise());
  Rng rng(5);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int n = 0; n < kDrives; ++n) {
    const Eigen::Vector3d error = (edge.T_i_j.inverse() * noisy_end(odometry, rng)).log();
    spread += error * error.transpose() / kDrives;
  }
  // Mean of chi-square with three degrees of freedom, within five standard deviations.
  EXPECT_NEAR((edge.covariance.inverse() * spread).trace(), 3, 5 * std::sqrt(6.0 / kDrives));
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(spread(i, i) / edge.covariance(i, i), 1, 5 * std::sqrt(2.0 / kDrives)) << i;
}

/// Motion reported by odometry with these constant errors.
template <class Pose>
Pose drifted_end(const Trajectory<SE3>& odometry, double yaw_drift_per_m_rad, double scale) {
  Pose end;
  for (std::size_t i = 0; i + 1 < odometry.size(); ++i) {
    const Pose step = pose_as<Pose>(odometry[i].pose).inverse() * pose_as<Pose>(odometry[i + 1].pose);
    typename Pose::Tangent xi = step.log();
    xi[Pose::kDof - 1] += yaw_drift_per_m_rad * step.translation().norm();
    xi.template head<Pose::kDim>() *= 1 + scale;
    end = end * Pose::exp(xi);
  }
  return end;
}

template <class Pose>
void expect_drift_jacobian(const Trajectory<SE3>& odometry) {
  const auto edge = odometry_edge<Pose>(odometry, 0, odometry.size() - 1, {});
  const auto slope = [&](double drift, double scale) -> typename Pose::Tangent {
    const auto ahead = (edge.T_i_j.inverse() * drifted_end<Pose>(odometry, drift, scale)).log();
    const auto behind = (edge.T_i_j.inverse() * drifted_end<Pose>(odometry, -drift, -scale)).log();
    return (ahead - behind) / 2e-6;
  };
  // Increments are short: only their own curvature, half a milliradian, is neglected.
  const typename Pose::Tangent drift = slope(1e-6, 0), scale = slope(0, 1e-6);
  EXPECT_LT((edge.drift_jacobian.col(0) - drift).norm(), 1e-3 * drift.norm());
  EXPECT_LT((edge.drift_jacobian.col(1) - scale).norm(), 1e-3 * scale.norm());
}

TEST(OdometryEdge, DriftJacobianIsTheSlopeOfTheComposedMotion) {
  static constexpr int kFiner = 40;
  const auto finer = [](double slope) {
    return [slope](int k) -> Tangent { return winding(k / kFiner, slope) / kFiner; };
  };
  expect_drift_jacobian<SE2>(drive(150 * kFiner, finer(0)));
  expect_drift_jacobian<SE3>(drive(150 * kFiner, finer(0.02)));
}

/// Noise recorded with the odometry, one step per second.
std::vector<OdometryStepNoise> measured_steps(int count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<OdometryStepNoise> steps;
  for (int k = 0; k < count; ++k) {
    SE3::Jacobian root;
    for (double& value : root.reshaped()) value = rng.normal(0, 0.002);
    steps.push_back({Stamp::from_seconds(k), Stamp::from_seconds(k + 1), root * root.transpose()});
  }
  return steps;
}

/// The same trajectory with additional samples.
Trajectory<SE3> with_further_rows(const Trajectory<SE3>& odometry, const std::vector<double>& seconds) {
  std::vector<StampedPose<SE3>> rows(odometry.begin(), odometry.end());
  for (const double s : seconds)
    rows.push_back({Stamp::from_seconds(s), *odometry.at(Stamp::from_seconds(s))});
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return Trajectory<SE3>(std::move(rows));
}

TEST(OdometryEdge, OfMeasuredStepsIsTheirChain) {
  const auto odometry = drive(6, [](int k) { return winding(k, 0.02); });
  OdometryNoise noise;
  noise.steps = measured_steps(6, 1);
  UncertainPose<SE3> chain;
  for (std::size_t k = 1; k <= 4; ++k)
    chain = chain * UncertainPose<SE3>{odometry[k].pose.inverse() * odometry[k + 1].pose,
                                       noise.steps[k].covariance_per_s};
  const auto edge = odometry_edge<SE3>(odometry, 1, 5, noise);
  const SE3::Jacobian floor = odometry_edge<SE3>(odometry, 1, 1, noise).covariance;
  EXPECT_LT((edge.covariance - floor - chain.covariance).norm(), 1e-9 * chain.covariance.norm());
}

/// Additional samples leave the covariance unchanged: exactly at rest, and in motion up to the lever arm of
/// half a step.
TEST(OdometryEdge, AMeasuredStepSplitInTwoEqualsTheWhole) {
  OdometryNoise noise;
  noise.steps = measured_steps(6, 2);
  const std::vector<double> cuts{0.5, 2.25, 2.75, 5.9};
  const auto expect_same = [&](const Trajectory<SE3>& whole, double tolerance) {
    const auto cut = with_further_rows(whole, cuts);
    const auto a = odometry_edge<SE3>(whole, 0, whole.size() - 1, noise);
    const auto b = odometry_edge<SE3>(cut, 0, cut.size() - 1, noise);
    EXPECT_LT((a.covariance - b.covariance).norm(), tolerance * a.covariance.norm());
    EXPECT_LT((a.T_i_j.inverse() * b.T_i_j).log().norm(), 1e-9);
    const auto c = odometry_edge<SE2>(whole, 0, whole.size() - 1, noise);
    const auto d = odometry_edge<SE2>(cut, 0, cut.size() - 1, noise);
    EXPECT_LT((c.covariance - d.covariance).norm(), tolerance * c.covariance.norm());
  };
  expect_same(drive(6, [](int) -> Tangent { return Tangent::Zero(); }), 1e-12);
  expect_same(drive(6, [](int k) { return winding(k, 0.02); }), 0.05);
}

TEST(OdometryEdge, CountsMeasuredStepsBetweenItsSamples) {
  OdometryNoise noise;
  for (const int begin : {2, 4}) {
    SE3::Jacobian per_s = SE3::Jacobian::Zero();
    per_s.diagonal().setConstant(1e-4 * begin);
    noise.steps.push_back({Stamp::from_seconds(begin), Stamp::from_seconds(begin + 1), per_s});
  }
  const auto at = [](double s) { return Stamp::from_seconds(s); };
  EXPECT_NEAR(measured_covariance(noise.steps, at(0), at(2))(0, 0), 0, 1e-15);
  EXPECT_NEAR(measured_covariance(noise.steps, at(2.25), at(2.75))(0, 0), 1e-4, 1e-12);
  EXPECT_NEAR(measured_covariance(noise.steps, at(2.5), at(4.5))(0, 0), 1e-4 + 2e-4, 1e-12);
  EXPECT_NEAR(measured_covariance(noise.steps, at(0), at(9))(0, 0), 2e-4 + 4e-4, 1e-12);
  EXPECT_NEAR(measured_covariance(noise.steps, at(5), at(9))(0, 0), 0, 1e-15);
  EXPECT_TRUE(measured_covariance({}, at(0), at(9)).isZero(0));
}

TEST(TravelledDistance, FollowsThePathAndIsClampedAtItsEnds) {
  const std::vector<StampedPose<SE3>> rows{{Stamp::from_seconds(1), SE3()},
                                           {Stamp::from_seconds(2), lift(SE2({3, 0}, 0))},
                                           {Stamp::from_seconds(4), lift(SE2({3, 4}, 1))}};
  const Trajectory<SE3> odometry(rows);
  const auto travelled_m = travelled_distance(odometry);
  EXPECT_EQ(travelled_m, std::vector<double>({0, 3, 7}));
  EXPECT_EQ(travelled_distance_at(odometry, travelled_m, Stamp::from_seconds(0)), 0);
  EXPECT_NEAR(travelled_distance_at(odometry, travelled_m, Stamp::from_seconds(1.5)), 1.5, 1e-12);
  EXPECT_NEAR(travelled_distance_at(odometry, travelled_m, Stamp::from_seconds(3)), 5, 1e-12);
  EXPECT_EQ(travelled_distance_at(odometry, travelled_m, Stamp::from_seconds(9)), 7);
  EXPECT_TRUE(travelled_distance({}).empty());
}

}  // namespace
}  // namespace radioslam
