#include "radioslam/geometry/local_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Where the axes of the ellipsoid end.
TEST(LocalFrame, ReproducesTheEarthsAxes) {
  const double b = 6356752.314245;
  EXPECT_LT((earth_centred_m({0, 0, 0}) - Eigen::Vector3d(6378137, 0, 0)).norm(), 1e-6);
  EXPECT_LT((earth_centred_m({0, 90 * kDegree, 10}) - Eigen::Vector3d(0, 6378147, 0)).norm(), 1e-6);
  EXPECT_LT((earth_centred_m({90 * kDegree, 0, 0}) - Eigen::Vector3d(0, 0, b)).norm(), 1e-5);
  EXPECT_LT((earth_centred_m({-90 * kDegree, 1, 5}) - Eigen::Vector3d(0, 0, -b - 5)).norm(), 1e-5);
}

/// A small step to the north has the length given by the meridian's curvature, to the east by the parallel's.
TEST(LocalFrame, StepLengthsFollowTheCurvature) {
  const double a = 6378137, e2 = 0.00669437999014, step = 1e-6;
  for (const double latitude_deg : {-70.0, 0.0, 48.0, 85.0}) {
    const GeodeticPlace origin{latitude_deg * kDegree, 11 * kDegree, 500};
    const double w = 1 - e2 * std::pow(std::sin(origin.latitude_rad), 2);
    const double meridian_m = a * (1 - e2) / std::pow(w, 1.5) + 500;
    const double parallel_m = (a / std::sqrt(w) + 500) * std::cos(origin.latitude_rad);
    const auto north = east_north_up_m(origin, {origin.latitude_rad + step, origin.longitude_rad, 500});
    const auto east = east_north_up_m(origin, {origin.latitude_rad, origin.longitude_rad + step, 500});
    const auto up = east_north_up_m(origin, {origin.latitude_rad, origin.longitude_rad, 507});
    EXPECT_LT((north - Eigen::Vector3d(0, meridian_m * step, 0)).norm(), 1e-4);
    EXPECT_LT((east - Eigen::Vector3d(parallel_m * step, 0, 0)).norm(), 1e-4);
    EXPECT_LT((up - Eigen::Vector3d(0, 0, 7)).norm(), 1e-6);
  }
}

TEST(LocalFrame, KeepsDistances) {
  const GeodeticPlace origin{0.8, 0.2, 100}, a{0.8001, 0.2003, 130}, b{0.7998, 0.1996, 90};
  EXPECT_NEAR((east_north_up_m(origin, a) - east_north_up_m(origin, b)).norm(),
              (earth_centred_m(a) - earth_centred_m(b)).norm(), 1e-6);
  EXPECT_EQ(east_north_up_m(origin, origin), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace radioslam
