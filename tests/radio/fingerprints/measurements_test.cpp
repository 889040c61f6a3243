#include "radioslam/radio/fingerprints/measurements.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>

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

/// What was known of a team after some time; its access points are those heard by then.
Mission known_after(const Mission& whole, double time_s) {
  Mission known = whole;
  std::set<std::string> names;
  for (Robot& robot : known.robots) {
    std::vector<StampedPose<SE3>> rows;
    for (std::size_t k = 0; k < robot.odometry.size(); ++k)
      if (robot.odometry[k].stamp.seconds() <= time_s) rows.push_back(robot.odometry[k]);
    robot.odometry = Trajectory<SE3>(std::move(rows));
    std::erase_if(robot.wifi, [&](const WifiScan& scan) { return scan.stamp.seconds() > time_s; });
    for (const WifiScan& scan : robot.wifi)
      for (const WifiReading& reading : scan.readings)
        names.insert(whole.access_points[reading.access_point.index()]);
  }
  known.access_points.assign(names.begin(), names.end());
  for (Robot& robot : known.robots)
    for (WifiScan& scan : robot.wifi)
      for (WifiReading& reading : scan.readings) {
        const auto name = names.find(whole.access_points[reading.access_point.index()]);
        reading.access_point = AccessPointIndex(static_cast<std::size_t>(std::distance(names.begin(), name)));
      }
  return known;
}

RadioMeasurements joined(RadioMeasurements radio) {
  radio.near_similarity = radio.layout_similarity = radio.near_similarity.joined(0.3);
  return radio;
}

std::vector<SimilarPair> near_pairs(const TeamSimilarity& of) {
  std::vector<SimilarPair> pairs;
  of.for_each_pair(0.3, [&](const SimilarPair& pair) { pairs.push_back(pair); });
  return pairs;
}

TEST(ContinueRadio, KeepsModelsAndGivesThePairsOfAJoinFromNothing) {
  const auto team = test::walking_team(3, Heading::kRelative, 300, 6);
  for (const double step_s : {3.0, 11.0, 47.0}) {
    RadioMeasurements radio = joined(measure_radio(known_after(team.mission, 205), {}, {}));
    const std::size_t fitted = radio.nodes.size();
    for (double time_s = 205 + step_s; time_s <= 300; time_s += step_s) {
      const Mission known = known_after(team.mission, time_s);
      const auto more = continue_radio(radio, known, {});
      ASSERT_TRUE(more);
      ASSERT_GT(more->nodes.size(), radio.nodes.size());
      EXPECT_EQ(more->fitted, fitted);
      EXPECT_EQ(more->near_model.samples().size(), radio.near_model.samples().size());
      std::vector<Fingerprint> all;
      for (std::size_t n = 0; n < more->nodes.size(); ++n) all.push_back(more->at(n).fingerprint);
      EXPECT_TRUE(near_pairs(more->near_similarity) ==
                  near_pairs(TeamSimilarity(all, SimilarityMeasure::kSorensen, {})));
      const EarlierNumbers earlier = earlier_nodes(*more, radio);
      const auto known_before = std::count_if(earlier.begin(), earlier.end(),
                                              [](const auto& number) { return number.has_value(); });
      EXPECT_GE(static_cast<std::size_t>(known_before) + 3, radio.nodes.size()) << "but each robot's last";
      radio = *more;
    }
  }
}

TEST(ContinueRadio, FitsAgainOnceFingerprintsHaveGrownByHalf) {
  const auto team = test::walking_team(2, Heading::kRelative, 400, 7);
  const auto radio = joined(measure_radio(known_after(team.mission, 200), {}, {}));
  EXPECT_TRUE(continue_radio(radio, known_after(team.mission, 290), {}));
  EXPECT_FALSE(continue_radio(radio, known_after(team.mission, 310), {}));
  EXPECT_FALSE(continue_radio(joined(measure_radio(known_after(team.mission, 1), {}, {})),
                              known_after(team.mission, 20), {}));
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
