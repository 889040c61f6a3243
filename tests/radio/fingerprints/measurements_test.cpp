#include "radioslam/radio/fingerprints/measurements.hpp"

#include <gtest/gtest.h>

#include "radio/fingerprints/walking_team.hpp"

namespace radioslam {
namespace {

TEST(MeasureRadio, PlacesEveryFingerprintOnItsOdometry) {
  const auto team = test::walking_team(2, Heading::kRelative, 30, 1);
  const auto radio = measure_radio(team.mission, {}, {});
  ASSERT_EQ(radio.nodes.size(), radio.robots[0].size() + radio.robots[1].size());
  ASSERT_EQ(radio.near_similarity.size(), radio.nodes.size());
  for (std::size_t n = 0; n < radio.nodes.size(); ++n) {
    const auto& placed = radio.at(n);
    const auto& walk = team.walks[radio.nodes[n].robot.index()];
    const auto second = static_cast<std::size_t>(placed.fingerprint.stamp.seconds());
    const SE2 expected = walk.front().inverse() * walk[second];
    EXPECT_LT((placed.T_start_body.translation().head<2>() - expected.translation()).norm(), 1e-9);
    EXPECT_NEAR(placed.travelled_m, static_cast<double>(second), 1e-9);
    EXPECT_LE(radio.nodes[n == 0 ? 0 : n - 1].robot, radio.nodes[n].robot);
  }
}

TEST(MeasureRadio, TrainsOnOneRobotsNearPairsOnly) {
  auto team = test::walking_team(3, Heading::kRelative, 60, 2);
  RadioParams params;
  params.fingerprint.window_s = 0;  // one fingerprint per scan
  params.distance_model.max_trusted_path_m = 10.5;
  const auto radio = measure_radio(team.mission, params, {});
  ASSERT_EQ(radio.nodes.size(), 90U);
  // Scans every two metres: five later partners within ten metres, fewer for the last five of a robot.
  EXPECT_EQ(radio.near_model.samples().size(), 3U * (25 * 5 + 4 + 3 + 2 + 1));
  for (const auto& sample : radio.near_model.samples()) EXPECT_LE(sample.distance_m, 10 + 1e-9);
}

TEST(MeasureRadio, UsesTheMeasuresAskedFor) {
  const auto team = test::walking_team(1, Heading::kRelative, 20, 3);
  RadioParams params;
  params.measure = "cosine";
  params.layout_measure = "gaussian";
  const auto radio = measure_radio(team.mission, params, {});
  const auto &a = radio.at(0).fingerprint, &b = radio.at(3).fingerprint;
  const auto expected = [&](SimilarityMeasure measure) {
    return static_cast<float>(similarity(a, b, measure, params.similarity));
  };
  EXPECT_EQ(radio.near_similarity.of(0, 3), expected(SimilarityMeasure::kCosine));
  EXPECT_EQ(radio.layout_similarity.of(0, 3), expected(SimilarityMeasure::kGaussian));
}

TEST(MeasureRadio, LearnsThatDistanceGrowsAsSimilarityFalls) {
  const auto team = test::walking_team(2, Heading::kRelative, 200, 4);
  const auto radio = measure_radio(team.mission, {}, {});
  const auto far = radio.near_model.predict(0.4), near = radio.near_model.predict(0.8);
  ASSERT_TRUE(far && near);
  EXPECT_LT(near->mean_m, 0.6 * far->mean_m);
  EXPECT_TRUE(radio.layout_model);
}

TEST(MeasureRadio, OfAMissionWithoutWifiIsEmpty) {
  auto team = test::walking_team(2, Heading::kRelative, 20, 5);
  for (Robot& robot : team.mission.robots) robot.wifi.clear();
  const auto radio = measure_radio(team.mission, {}, {});
  EXPECT_TRUE(radio.nodes.empty());
  EXPECT_FALSE(radio.layout_model);
  EXPECT_FALSE(radio.near_model.predict(0.5));
}

}  // namespace
}  // namespace radioslam
