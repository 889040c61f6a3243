// Access points and signals on the page.
#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/report/access_point_data.hpp"

namespace radioslam {
namespace {

AccessPointResult ellipse_along_y() {
  AccessPointResult point;
  point.bssid = "02:00:00:00:00:01";
  point.position_m = {3, 1};
  point.covariance = Eigen::Vector4d(1, 9, 1, 1).asDiagonal();
  point.readings = 40;
  point.heard = {{1, 0, -60}};
  return point;
}

TEST(ReportAccessPoints, TurnWithThePage) {
  RunResult result;
  result.access_points = {ellipse_along_y()};
  const double quarter = std::acos(0.0);
  const PageData data = access_point_data(result, lift(SE2({10, 0}, quarter)), {});
  ASSERT_EQ(data["points"].size(), 1U);
  const PageData& point = data["points"][0];
  EXPECT_NEAR(point["x"].get<double>(), 9, 0.006);
  EXPECT_NEAR(point["y"].get<double>(), 3, 0.006);
  EXPECT_NEAR(point["major_m"].get<double>(), 3, 0.006);
  EXPECT_NEAR(point["minor_m"].get<double>(), 1, 0.006);
  // The long axis is along x now, in either direction.
  EXPECT_NEAR(std::abs(std::sin(point["turn_rad"].get<double>())), 0, 0.001);
  EXPECT_NEAR(point["heard"][0][1].get<double>(), 1, 0.006);
  EXPECT_FALSE(point.contains("rival"));
}

TEST(ReportAccessPoints, OfTooManyTheMostReceivedAreDrawn) {
  RunResult result;
  for (std::size_t k = 0; k < 10; ++k) {
    result.access_points.push_back(ellipse_along_y());
    result.access_points.back().readings = k;
  }
  ReportParams params;
  params.max_access_points = 3;
  const PageData data = access_point_data(result, SE3(), params);
  EXPECT_EQ(data["placed"], 10);
  ASSERT_EQ(data["points"].size(), 3U);
  EXPECT_EQ(data["points"][0]["readings"], 7);
}

TEST(ReportAccessPoints, SignalsAreThinnedToTheirBudget) {
  RunResult result;
  SignalResult signal{"a", "02:00:00:00:00:01", {}, {}};
  for (int k = 0; k < 1000; ++k) {
    signal.stamps.push_back(Stamp::from_seconds(k));
    signal.rss_dbm.push_back(-50);
  }
  result.signals = {signal, signal};
  ReportParams params;
  params.max_signal_values = 200;
  const PageData data = signal_data(result, Stamp::from_seconds(0), params);
  EXPECT_EQ(data["signals"][0]["t"].size(), 100U);
  EXPECT_EQ(data["signals"][0]["rss_dbm"].size(), 100U);
  EXPECT_EQ(data["signals"][0]["t"].back(), 999.0);
}

}  // namespace
}  // namespace radioslam
