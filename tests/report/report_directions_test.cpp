// Measured directions on the page.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "radioslam/report/aoa_data.hpp"
#include "report/sample_page.hpp"

namespace radioslam {
namespace {

using sample::data_of;
using sample::evaluated_page;
using sample::Json;
using sample::make_sample;
using sample::Sample;

constexpr double kRounding = 0.00051;

TEST(ReportDirections, AreThoseOfTheRun) {
  const Sample sample = make_sample({.keyframes = 100, .closures = 5, .aoa_measurements = 6});
  const Json aoa_measurements = data_of(evaluated_page(sample))["aoa_measurements"];
  EXPECT_EQ(aoa_measurements["measured"], 6);
  ASSERT_EQ(aoa_measurements["drawn"].size(), 6u);
  const auto& measured = sample.result.aoa_measurements[0];  // a's, of b: the first by name and time
  const Json& shown = aoa_measurements["drawn"][0];
  EXPECT_EQ(shown["receiver"], "a");
  EXPECT_EQ(shown["transmitter"], "b");
  EXPECT_NEAR(shown["t"].get<double>(),
              seconds_between(sample.result.robots[0].estimate.front().stamp, measured.stamp), kRounding);
  EXPECT_NEAR(shown["estimated_azimuth_rad"].get<double>(), *measured.estimated_azimuth_rad, kRounding);
  ASSERT_EQ(shown["peaks"].size(), measured.peaks.size());
  for (std::size_t p = 0; p < measured.peaks.size(); ++p) {
    EXPECT_NEAR(shown["peaks"][p]["azimuth_rad"].get<double>(), measured.peaks[p].azimuth_rad, kRounding);
    EXPECT_NEAR(shown["peaks"][p]["sigma_rad"].get<double>(), measured.peaks[p].sigma_rad, kRounding);
    EXPECT_NEAR(shown["peaks"][p]["power_db"].get<double>(), measured.peaks[p].power_db, 0.051);
    EXPECT_EQ(shown["peaks"][p]["ghost"], measured.peaks[p].is_cross_term);
  }
}

TEST(ReportDirections, AreByReceiverTransmitterAndTime) {
  const Json drawn = data_of(evaluated_page(
      make_sample({.keyframes = 300, .closures = 5, .aoa_measurements = 24})))["aoa_measurements"]["drawn"];
  const auto key = [](const Json& one) {
    return std::tuple(one["receiver"].get<std::string>(), one["transmitter"].get<std::string>(),
                      one["t"].get<double>());
  };
  EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end(),
                             [&](const Json& a, const Json& b) { return key(a) < key(b); }));
}

TEST(ReportDirections, TheTrueOneIsInTheReceiversBody) {
  Sample sample = make_sample({.keyframes = 30, .closures = 5, .aoa_measurements = 1});
  const Stamp stamp = sample.result.aoa_measurements[0].stamp;
  const auto stand = [&](std::size_t robot, const SE3& pose) {
    const Stamp later{stamp.ns + 1'000'000'000};
    sample.truth.robots[robot].poses = Trajectory<SE3>({{stamp, pose}, {later, pose}});
  };
  stand(0, lift(SE2({1, 1}, M_PI / 2)));
  stand(1, lift(SE2({4, 1}, 0)));
  const Json shown = data_of(evaluated_page(sample))["aoa_measurements"]["drawn"][0];
  EXPECT_NEAR(shown["true_azimuth_rad"].get<double>(), -M_PI / 2, kRounding);  // east of one who looks north
}

TEST(ReportDirections, TheTrueOneNeedsTheReceiversHeadingAndBothPlaces) {
  const auto shows_truth = [](const Sample& sample) {
    return data_of(evaluated_page(sample))["aoa_measurements"]["drawn"][0].contains("true_azimuth_rad");
  };
  Sample sample = make_sample({.keyframes = 100, .closures = 5, .aoa_measurements = 1});
  EXPECT_TRUE(shows_truth(sample));
  sample.truth.robots[1].has_orientation = false;
  EXPECT_TRUE(shows_truth(sample));
  sample.truth.robots[0].has_orientation = false;
  EXPECT_FALSE(shows_truth(sample));
  sample.truth.robots[0].has_orientation = true;
  sample.result.aoa_measurements[0].transmitter = "an anchor";
  EXPECT_FALSE(shows_truth(sample));
  const Json alone = data_of(render_report(sample.result));
  EXPECT_FALSE(alone["aoa_measurements"]["drawn"][0].contains("true_azimuth_rad"));
}

TEST(ReportDirections, AreAbsentWhereThereAreNone) {
  EXPECT_FALSE(
      data_of(evaluated_page(make_sample({.keyframes = 20, .closures = 5}))).contains("aoa_measurements"));
}

TEST(ReportDirections, AnUnknownEstimateIsAbsent) {
  Sample sample = make_sample({.keyframes = 100, .closures = 5, .aoa_measurements = 1});
  sample.result.aoa_measurements[0].estimated_azimuth_rad.reset();
  EXPECT_FALSE(
      data_of(evaluated_page(sample))["aoa_measurements"]["drawn"][0].contains("estimated_azimuth_rad"));
}

TEST(ReportDirections, AFewOfManyAreDrawnAndAllAreCounted) {
  const Sample sample = make_sample({.keyframes = 300, .closures = 5, .aoa_measurements = 200});
  const Json aoa_measurements = data_of(evaluated_page(sample))["aoa_measurements"];
  EXPECT_EQ(aoa_measurements["measured"], 200);
  EXPECT_EQ(aoa_measurements["drawn"].size(), 60u);
  for (const Json& one : aoa_measurements["drawn"]) EXPECT_EQ(one["profile"].size(), 180u);
  ReportParams params;
  params.max_aoa_measurements = 10;
  params.max_profile_values = 90;
  const Json fewer = data_of(evaluated_page(sample, params))["aoa_measurements"];
  EXPECT_EQ(fewer["drawn"].size(), 10u);
  EXPECT_EQ(fewer["drawn"][9]["profile"].size(), 90u);
}

TEST(ThinnedProfile, KeepsEveryPeakAtItsPlace) {
  std::vector<float> profile(360, 0.125F);
  profile[0] = 0.5F;
  profile[101] = 1;
  const auto thinned = thinned_profile(profile, 180);
  ASSERT_EQ(thinned.size(), 180u);
  EXPECT_EQ(thinned[0], 0.5F);
  EXPECT_EQ(thinned[51], 1);  // 101 is as far from 50 as from 51
  EXPECT_EQ(std::count(thinned.begin(), thinned.end(), 0.125F), 178);
}

TEST(ThinnedProfile, ClosesTheCircle) {
  std::vector<float> profile(100, 0);
  profile[99] = 1;  // nearest to the first of ten
  EXPECT_EQ(thinned_profile(profile, 10)[0], 1);
}

TEST(ThinnedProfile, LeavesAShortOneAsItIs) {
  const std::vector<float> profile{1, 2, 3};
  EXPECT_EQ(thinned_profile(profile, 3), profile);
  EXPECT_TRUE(thinned_profile({}, 3).empty());
}

}  // namespace
}  // namespace radioslam
