#include "radioslam/closure/fingerprint_closures.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

constexpr double kNear = 0.9, kFar = 0.3, kUntrained = 0.6;
constexpr double kNearest_m = 0.5, kNear_m = 2, kFar_m = 20;

/// Maps the similarities above to 2 m, 20 m and nothing. The most similar pairs are half a metre apart.
DistanceModel trained_model() {
  std::vector<DistanceSample> samples;
  for (int i = 0; i < 40; ++i) {
    samples.push_back({0.97, kNearest_m});
    samples.push_back({kNear, kNear_m + (i % 2 == 0 ? 0.5 : -0.5)});
    samples.push_back({kFar, kFar_m + (i % 2 == 0 ? 3 : -3)});
  }
  DistanceModelParams params;
  params.even_distances = false;
  return DistanceModel(std::move(samples), params);
}

/// Fingerprints at these path lengths of each robot, all equally similar.
RadioMeasurements measured(const std::vector<std::vector<double>>& travelled_m, double similarity) {
  RadioMeasurements radio{{}, {}, {}, {}, trained_model(), MedianModel::fit({{0.5, 10}}, 1), {}, {}};
  for (std::size_t r = 0; r < travelled_m.size(); ++r) {
    radio.robots.emplace_back();
    for (std::size_t i = 0; i < travelled_m[r].size(); ++i) {
      radio.robots[r].push_back({{}, SE3(), travelled_m[r][i]});
      radio.nodes.push_back({RobotIndex(r), i});
    }
  }
  const std::vector<float> row(radio.nodes.size(), static_cast<float>(similarity));
  radio.near_similarity = TeamSimilarity(std::vector<std::vector<float>>(radio.nodes.size(), row));
  radio.layout_similarity = radio.near_similarity;
  return radio;
}

/// A place per fingerprint, four metres from the next.
Eigen::Matrix3Xd places_of(const RadioMeasurements& radio) {
  Eigen::Matrix3Xd places = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(radio.nodes.size()));
  for (Eigen::Index k = 0; k < places.cols(); ++k) places(0, k) = 4 * static_cast<double>(k);
  return places;
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs pairs(const std::vector<FingerprintClosure>& closures) {
  Pairs pairs;
  for (const auto& closure : closures) pairs.emplace_back(closure.node_i, closure.node_j);
  return pairs;
}

/// Robots, some with a known start.
Mission team(const std::vector<bool>& knows_start) {
  Mission mission;
  for (const bool known : knows_start) {
    mission.robots.emplace_back();
    if (known) mission.robots.back().initial_pose = SE3();
  }
  return mission;
}

TEST(NearClosures, WithinARobotOnlyBeyondTheTrustedPath) {
  const auto radio = measured({{0, 50, 150, 151}}, kNear);
  EXPECT_EQ(pairs(propose_near_closures(radio, 100, {})), Pairs({{0, 2}, {0, 3}, {1, 3}}));
  EXPECT_EQ(pairs(propose_near_closures(radio, 1000, {})), Pairs());
}

TEST(NearClosures, BetweenRobotsAtAnyPathLength) {
  const auto radio = measured({{0, 10}, {0}}, kNear);
  EXPECT_EQ(pairs(propose_near_closures(radio, 100, {})), Pairs({{0, 2}, {1, 2}}));
}

TEST(NearClosures, OnlyBelowTheirLargestDistance) {
  const auto radio = measured({{0, 150}, {0}}, kNear);
  FingerprintClosureParams params;
  params.within_distance_m = kNear_m - 0.1;
  EXPECT_EQ(pairs(propose_near_closures(radio, 100, params)), Pairs({{0, 2}, {1, 2}}));
  params.within_distance_m = kNear_m + 0.1;
  params.between_distance_m = kNear_m - 0.1;
  EXPECT_EQ(pairs(propose_near_closures(radio, 100, params)), Pairs({{0, 1}}));
}

TEST(NearClosures, ReachAtLeastAFewTimesTheSmallestPrediction) {
  const auto radio = measured({{0, 150}, {0}}, kNear);
  FingerprintClosureParams params;
  params.within_distance_m = params.between_distance_m = 0.1;
  params.nearest_factor = 0.9 * kNear_m / kNearest_m;
  EXPECT_TRUE(propose_near_closures(radio, 100, params).empty());
  params.nearest_factor = 1.1 * kNear_m / kNearest_m;
  EXPECT_EQ(propose_near_closures(radio, 100, params).size(), 3U);
}

TEST(NearClosures, OnlyWhereTheModelPredictsANearDistance) {
  EXPECT_TRUE(propose_near_closures(measured({{0}, {0}}, kFar), 100, {}).empty());
  EXPECT_TRUE(propose_near_closures(measured({{0}, {0}}, kUntrained), 100, {}).empty());
  EXPECT_TRUE(propose_near_closures(measured({{0}, {0}}, 0), 100, {}).empty());
}

TEST(NearClosures, CarryThePredictedDistance) {
  const auto closures = propose_near_closures(measured({{0}, {0}}, kNear), 100, {});
  ASSERT_EQ(closures.size(), 1U);
  EXPECT_NEAR(closures[0].similarity, kNear, 1e-6);
  EXPECT_NEAR(closures[0].predicted.mean_m, kNear_m, 1e-9);
  EXPECT_NEAR(closures[0].predicted.sigma_m, 0.5, 1e-9);
  EXPECT_EQ(closures[0].predicted.samples, 40);
}

TEST(NearClosures, AreWeightedByThePairsOfTheirFingerprints) {
  // Every fingerprint is in six pairs.
  const auto radio = measured({{0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4, 5}}, kNear);
  FingerprintClosureParams params;
  params.independent_pairs = 0.5;
  const auto closures = propose_near_closures(radio, 100, params);
  ASSERT_EQ(closures.size(), 36U);
  std::vector<double> evidence(radio.nodes.size(), 0);
  for (const auto& closure : closures) {
    evidence[closure.node_i] += closure.weight;
    evidence[closure.node_j] += closure.weight;
  }
  for (const double e : evidence) EXPECT_NEAR(e, 0.5, 1e-9);
}

TEST(NearClosures, NeverWeighMoreThanOne) {
  FingerprintClosureParams params;
  params.independent_pairs = 3;
  const auto closures = propose_near_closures(measured({{0, 1}, {0}}, kNear), 100, params);
  ASSERT_EQ(closures.size(), 2U);
  for (const auto& closure : closures) EXPECT_EQ(closure.weight, 1);
}

TEST(LayoutClosures, OnlyWhereAStartIsUnknown) {
  const auto radio = measured({{0, 1}, {0}, {0}}, kFar);
  EXPECT_EQ(
      pairs(propose_layout_closures(known_starts(team({true, true, true})), radio, places_of(radio), {}, {})),
      Pairs());
  EXPECT_EQ(pairs(propose_layout_closures(known_starts(team({true, true, false})), radio, places_of(radio),
                                          {}, {})),
            Pairs({{0, 3}, {1, 3}, {2, 3}}));
  EXPECT_EQ(pairs(propose_layout_closures(known_starts(team({false, false, false})), radio, places_of(radio),
                                          {}, {})),
            Pairs({{0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}));
}

TEST(LayoutClosures, CarryTheDistanceOfTheLayout) {
  const auto radio = measured({{0}, {0}}, std::exp(-1.0));
  LayoutParams layout;
  layout.sigma_m = 3;
  layout.sigma_relative = 0.4;
  const auto closures =
      propose_layout_closures(known_starts(team({false, false})), radio, places_of(radio), layout, {});
  ASSERT_EQ(closures.size(), 1U);
  EXPECT_NEAR(closures[0].predicted.peak_m, 4, 1e-9);
  EXPECT_NEAR(closures[0].predicted.spread_m, std::hypot(3, 1.6), 1e-9);
  EXPECT_EQ(closures[0].weight, 1);
}

TEST(LayoutClosures, NoneWithoutAModelOrWithHardlyAnythingInCommon) {
  const auto mission = team({false, false});
  LayoutParams layout;
  layout.min_similarity = 0.35;
  EXPECT_TRUE(propose_layout_closures(known_starts(mission), measured({{0}, {0}}, kFar),
                                      places_of(measured({{0}, {0}}, kFar)), layout, {})
                  .empty());
  auto untrained = measured({{0}, {0}}, kNear);
  untrained.layout_model.reset();
  EXPECT_TRUE(
      propose_layout_closures(known_starts(mission), untrained, places_of(untrained), {}, {}).empty());
}

/// They share the layout's error, however many fingerprints the two robots have.
TEST(LayoutClosures, AllOfTwoRobotsWeighAsMuchAsOneMeasurement) {
  const std::vector<double> ways(40, 0);
  const auto radio = measured({ways, ways}, kFar);
  const auto mission = team({false, false});
  const LayoutParams layout;
  FingerprintClosureParams params;
  for (const int most : {1, 7, 100, 1600, 5000}) {
    params.layout_pairs = most;
    const auto closures =
        propose_layout_closures(known_starts(mission), radio, places_of(radio), layout, params);
    EXPECT_LE(closures.size(), static_cast<std::size_t>(most));
    double weight = 0;
    for (const auto& closure : closures) weight += closure.weight;
    EXPECT_NEAR(weight, 1, 1e-9) << most;
    EXPECT_EQ(pairs(closures),
              pairs(propose_layout_closures(known_starts(mission), radio, places_of(radio), layout, params)));
  }
  params.layout_pairs = 0;
  EXPECT_TRUE(
      propose_layout_closures(known_starts(mission), radio, places_of(radio), layout, params).empty());
}

TEST(FingerprintClosures, AreTheNearOnesFollowedByThoseOfTheLayout) {
  const auto radio = measured({{0}, {0}}, kNear);
  EXPECT_EQ(pairs(propose_fingerprint_closures(known_starts(team({true, true})), radio, places_of(radio), 100,
                                               {}, {})),
            Pairs({{0, 1}}));
  const auto both =
      propose_fingerprint_closures(known_starts(team({true, false})), radio, places_of(radio), 100, {}, {});
  ASSERT_EQ(pairs(both), Pairs({{0, 1}, {0, 1}}));
  EXPECT_NEAR(both[0].predicted.mean_m, kNear_m, 1e-9);
  EXPECT_NEAR(both[1].predicted.mean_m, 4, 1e-9);
}

}  // namespace
}  // namespace radioslam
