#include "radioslam/radio/aoa/aoa_likelihood.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSigma = 10 * kDegree;

/// Without errors of the antenna positions.
AoaLikelihoodParams bare(const std::string& form = "gaussian") {
  AoaLikelihoodParams params;
  params.form = form;
  params.sigma_antenna_position_m = 0;
  return params;
}

AoaPath path(double azimuth_deg, std::optional<double> elevation_deg = {}, double sigma_rad = kSigma) {
  AoaPath result;
  result.azimuth_rad = azimuth_deg * kDegree;
  if (elevation_deg) result.elevation_rad = *elevation_deg * kDegree;
  result.sigma_rad = sigma_rad;
  return result;
}

AoaMeasurement heard(std::vector<AoaPath> paths) {
  AoaMeasurement measured;
  measured.paths = std::move(paths);
  return measured;
}

/// A pose ten metres away in this direction.
SE3 facing(double azimuth_deg, double elevation_deg = 0) {
  const double azimuth = azimuth_deg * kDegree, elevation = elevation_deg * kDegree;
  return {10 * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                               std::cos(elevation) * std::sin(azimuth), std::sin(elevation)),
          Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()))};
}

TEST(AngleWeight, GaussianByHand) {
  EXPECT_DOUBLE_EQ(angle_weight(0, kSigma, AngleWeight::kGaussian), 1);
  EXPECT_NEAR(angle_weight(kSigma, kSigma, AngleWeight::kGaussian), 0.6065306597126334, 1e-15);
  EXPECT_NEAR(angle_weight(-2 * kSigma, kSigma, AngleWeight::kGaussian), 0.1353352832366127, 1e-15);
}

/// With sigma = 8.5 degrees = 0.148353 rad: exp(-x^2 / 2 sigma^2) = sigma at x = sigma sqrt(-2 log sigma) =
/// 16.6 degrees, up to where it is 1; at 3 sigma it is exp(-4.5) / 0.148353 = 0.07488.
TEST(AngleWeight, CappedByHand) {
  const double sigma = 8.5 * kDegree;
  EXPECT_DOUBLE_EQ(angle_weight(16.60 * kDegree, sigma, AngleWeight::kCapped), 1);
  EXPECT_LT(angle_weight(16.62 * kDegree, sigma, AngleWeight::kCapped), 1);
  EXPECT_NEAR(angle_weight(3 * sigma, sigma, AngleWeight::kCapped), 0.07488, 1e-5);
  EXPECT_NEAR(angle_weight(0, 2, AngleWeight::kCapped), 0.5, 1e-15);
}

TEST(CheckRelativePose, WithAnAzimuthAlone) {
  const AoaAgreement check = check_relative_pose(facing(30), heard({path(50)}), bare());
  EXPECT_NEAR(check.azimuth_error_rad, -20 * kDegree, 1e-12);
  EXPECT_FALSE(check.elevation_error_rad);
  EXPECT_NEAR(check.weight, std::exp(-2.0), 1e-12);
  EXPECT_EQ(check.status, AngleStatus::kBeyond);
  EXPECT_EQ(check.information_scale(), check.weight);
}

TEST(CheckRelativePose, InSpace) {
  const AoaAgreement check = check_relative_pose(facing(30, 60), heard({path(40, 55, kSigma)}), bare());
  EXPECT_NEAR(check.azimuth_error_rad, -10 * kDegree, 1e-12);
  EXPECT_NEAR(*check.elevation_error_rad, 5 * kDegree, 1e-12);
  EXPECT_NEAR(check.azimuth_sigma_rad, 2 * kSigma, 1e-12);  // 1 / cos(60 degrees)
  EXPECT_NEAR(check.elevation_sigma_rad, kSigma, 1e-12);
  EXPECT_NEAR(check.weight, std::exp(-0.5 * (0.25 + 0.25)), 1e-12);
}

TEST(CheckRelativePose, EitherErrorMayReachTheThreshold) {
  const auto status = [](double azimuth_deg, double elevation_deg) {
    return check_relative_pose(facing(0, 0), heard({path(azimuth_deg, elevation_deg)}), bare()).status;
  };
  EXPECT_EQ(status(8.4, 8.4), AngleStatus::kAgrees);
  EXPECT_EQ(status(8.6, 0), AngleStatus::kBeyond);
  EXPECT_EQ(status(0, -8.6), AngleStatus::kBeyond);
}

TEST(CheckRelativePose, WithinTheThresholdNothingIsLost) {
  const AoaAgreement check = check_relative_pose(facing(0), heard({path(8)}), bare());
  EXPECT_LT(check.weight, 0.8);
  EXPECT_EQ(check.information_scale(), 1);
}

TEST(CheckRelativePose, WrapsAround) {
  const AoaAgreement check = check_relative_pose(facing(-178), heard({path(176)}), bare());
  EXPECT_NEAR(check.azimuth_error_rad, 6 * kDegree, 1e-12);
  EXPECT_EQ(check.status, AngleStatus::kAgrees);
}

TEST(CheckRelativePose, TakesTheNearestPathBySumOfBothErrors) {
  // Sums of errors: 25 = 20 + 5, 24 = 4 + 20, 23 = 22 (wrapped) + 1.
  const auto measured = heard({path(-150, 5), path(-174, 20), path(168, 1)});
  const AoaAgreement check = check_relative_pose(facing(-170), measured, bare());
  EXPECT_EQ(check.nearest_path, 2U);
  EXPECT_NEAR(check.azimuth_error_rad, 22 * kDegree, 1e-12);
}

TEST(CheckRelativePose, ElevationsThatWereNotMeasuredAgree) {
  const auto measured = heard({path(0, 0), path(3)});
  const AoaAgreement check = check_relative_pose(facing(0, 20), measured, bare());
  EXPECT_EQ(check.nearest_path, 1U);
  EXPECT_FALSE(check.elevation_error_rad);
}

TEST(CheckRelativePose, WidensByPlaceAndPrediction) {
  AoaLikelihoodParams params;
  params.sigma_antenna_position_m = 1;
  const AoaAgreement check = check_relative_pose(facing(30), heard({path(50)}), params, {0.2, 0});
  EXPECT_NEAR(check.azimuth_sigma_rad, std::sqrt(kSigma * kSigma + 0.01 + 0.04), 1e-12);
}

TEST(CheckRelativePose, LooksForTheAntennaNotTheBody) {
  AoaMeasurement measured = heard({path(90)});
  measured.transmitter.lever_arm_m = {0, 3, 0};
  const SE3 T_i_j({0, 1, 0},
                  Eigen::Quaterniond(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitZ())));
  EXPECT_NEAR(check_relative_pose(T_i_j, measured, bare()).azimuth_error_rad,
              std::atan2(1, 3) - std::numbers::pi / 2, 1e-12);
}

TEST(CheckRelativePose, AtNoDistanceAgrees) {
  const AoaAgreement check = check_relative_pose(SE3(), heard({path(90, 40)}), bare());
  EXPECT_EQ(check.weight, 1);
  EXPECT_EQ(check.status, AngleStatus::kAgrees);
}

/// By hand: with sigma = 10 degrees a peak is sqrt(2 pi) / sigma = 14.3619 times uniform.
TEST(LogOddsElsewhere, ByHand) {
  const double P = 0.8;
  const auto odds = [&](double azimuth_deg, const std::vector<AoaPath>& paths, double band_rad = 0) {
    return std::exp(log_odds_elsewhere(facing(azimuth_deg), heard(paths), P, band_rad, bare()));
  };
  EXPECT_NEAR(odds(0, {path(0)}), 1 / (0.2 + 0.8 * 14.3619), 1e-6);
  EXPECT_NEAR(odds(0, {path(90)}), 5, 1e-6);
  EXPECT_NEAR(odds(-175, {path(175)}), 1 / (0.2 + 0.8 * 14.3619 * std::exp(-0.5)), 1e-6);
  EXPECT_NEAR(odds(0, {path(0), path(90), path(-90), path(180)}), 1 / (0.2 + 0.2 * 14.3619), 1e-6);
  EXPECT_NEAR(odds(0, {path(30)}, 20 * kDegree), 1 / (0.2 + 0.8 * 14.3619 * std::exp(-0.5)), 1e-6);
}

/// The property of an e-value: if one of the paths is direct with probability P, the mean is 1.
TEST(LogOddsElsewhere, HasAMeanOfOneUnderACorrectPose) {
  const double P = 0.8;
  for (const auto& paths : {std::vector{path(0)}, std::vector{path(0), path(15)},
                            std::vector{path(170), path(-60), path(20, {}, 0.6)}}) {
    double mean = 0, all = 0;
    const double step_deg = 0.25;
    for (double azimuth_deg = -180; azimuth_deg < 180; azimuth_deg += step_deg) {
      double density = (1 - P) / (2 * std::numbers::pi);
      for (const AoaPath& one : paths) {
        const double off = wrap_angle(azimuth_deg * kDegree - one.azimuth_rad) / one.sigma_rad;
        density += P / static_cast<double>(paths.size()) * std::exp(-off * off / 2) /
                   (one.sigma_rad * std::sqrt(2 * std::numbers::pi));
      }
      all += density * step_deg * kDegree;
      mean += density * step_deg * kDegree *
              std::exp(log_odds_elsewhere(facing(azimuth_deg), heard(paths), P, 0, bare()));
    }
    EXPECT_NEAR(all, 1, 1e-6);
    EXPECT_NEAR(mean, 1, 1e-6);
  }
}

TEST(Levelled, TakesOffRollAndPitch) {
  // Rolled by 90 degrees to the right about body x: body z points along -y of the levelled frame.
  const SE3 rolled(Eigen::Vector3d::Zero(),
                   Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX())));
  const auto level = levelled(heard({path(0, 45), path(30, 0)}), rolled);
  EXPECT_NEAR(level.paths[0].azimuth_rad, -45 * kDegree, 1e-12);
  EXPECT_NEAR(level.paths[1].azimuth_rad, 0, 1e-12);  // projected onto the horizontal plane
  EXPECT_FALSE(level.paths[0].elevation_rad);
}

}  // namespace
}  // namespace radioslam
