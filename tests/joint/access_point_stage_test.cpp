#include "radioslam/joint/access_point_stage.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <Eigen/LU>
#include <algorithm>

#include "radioslam/base/parallel.hpp"
#include "radioslam/sim/scenarios/carpark.hpp"

namespace radioslam {
namespace {

/// A result whose estimate is the truth.
RunResult true_result(const Mission& mission, const Truth& truth) {
  RunResult result;
  result.components.emplace_back();
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    RobotResult robot;
    robot.id = mission.robots[r].id;
    robot.estimate = truth.robots[r].poses;
    result.components.front().robots.push_back(robot.id);
    result.robots.push_back(std::move(robot));
  }
  return result;
}

struct PlacedCarpark {
  RunResult result;
  std::vector<Transmitter> transmitters;
};

PlacedCarpark place(std::uint64_t seed) {
  CarparkParams params;
  params.transmitters.access_points = 40;
  params.odometry.draws = 1;
  const auto [mission, truth] = simulate_carpark(params, seed);
  PlacedCarpark placed{true_result(mission, truth), make_carpark_world(params, seed).transmitters};
  RadioParams radio;
  add_access_points(placed.result, mission, measure_radio(mission, radio, {}), {});
  return placed;
}

Eigen::Vector2d true_place(const PlacedCarpark& placed, const std::string& bssid) {
  for (const Transmitter& radio : placed.transmitters)
    if (radio.bssid() == bssid) return radio.position().head<2>();
  return Eigen::Vector2d::Constant(1e9);
}

TEST(AccessPointStage, CovariancesHoldAgainstTheSimulatorsTruth) {
  double sum = 0;
  std::size_t found = 0, beyond = 0;
  std::vector<double> errors;
  for (const std::uint64_t seed : {21U, 22U, 23U}) {
    const PlacedCarpark placed = place(seed);
    for (const auto& point : placed.result.access_points) {
      if (point.status != AccessPointStatus::kFound) continue;
      const Eigen::Vector2d off = point.position_m - true_place(placed, point.bssid);
      const double nees = off.dot(point.covariance.topLeftCorner<2, 2>().inverse() * off);
      sum += nees / 2;
      beyond += nees > 5.99 ? 1U : 0U;  // 5 % for a calibrated covariance
      ++found;
      errors.push_back(off.norm());
    }
  }
  ASSERT_GE(found, 60U);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 4);
  EXPECT_LT(sum / static_cast<double>(found), 2);
  EXPECT_LT(static_cast<double>(beyond), 0.15 * static_cast<double>(found));
}

TEST(AccessPointStage, ReportsSignalsAndSimilarity) {
  const RunResult result = place(24).result;
  EXPECT_EQ(result.similarity_over_time.size(), 32U) << "sixteen fingerprints per robot";
  ASSERT_FALSE(result.signals.empty());
  for (const auto& signal : result.signals) EXPECT_EQ(signal.stamps.size(), signal.rss_dbm.size());
  EXPECT_EQ(result.counts.at("access_points"), static_cast<double>(result.access_points.size()));
  EXPECT_TRUE(std::is_sorted(result.access_points.begin(), result.access_points.end(),
                             [](const auto& a, const auto& b) { return a.bssid < b.bssid; }));
}

TEST(AccessPointStage, ARobotInAFrameOfItsOwnTakesNoPart) {
  CarparkParams params;
  params.drive.path_length_m = 100;
  params.odometry.draws = 1;
  const auto [mission, truth] = simulate_carpark(params, 25);
  RunResult both = true_result(mission, truth), alone = both;
  alone.components = {{{mission.robots[0].id}}, {{mission.robots[1].id}}};
  const auto radio = measure_radio(mission, {}, {});
  add_access_points(both, mission, radio, {});
  add_access_points(alone, mission, radio, {});
  const auto readings = [](const RunResult& result) {
    std::size_t sum = 0;
    for (const auto& point : result.access_points) sum += point.readings;
    return sum;
  };
  EXPECT_LT(readings(alone), readings(both));
}

/// Peak memory of this process so far.
double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

TEST(AccessPointStage, OnesReceivedOnceCostNoMemoryPerSite) {
  // A site for each of their undetected readings would be 16 bytes x 60,000 x 600: 550 MiB.
  constexpr std::size_t kFingerprints = 600, kNewOnes = 100;
  Mission mission;
  mission.robots.resize(1);
  RunResult result;
  result.components.push_back({});
  result.components.front().robots.push_back("");
  RadioMeasurements radio{{{}}, {}, {}, {}, DistanceModel({}, {}), {}, {}, {}};
  std::vector<StampedPose<SE3>> way;
  for (std::size_t k = 0; k < kFingerprints; ++k) {
    Fingerprint fingerprint{Stamp::from_seconds(static_cast<double>(k)), 1, {}};
    for (std::size_t a = 0; a < kNewOnes; ++a) {
      fingerprint.entries.push_back({AccessPointIndex(mission.access_points.size()), -70, 1});
      mission.access_points.push_back(std::to_string(mission.access_points.size()));
    }
    way.push_back({fingerprint.stamp, lift(SE2({static_cast<double>(k), 0}, 0))});
    radio.robots.front().push_back({std::move(fingerprint), way.back().pose, static_cast<double>(k)});
    radio.nodes.push_back({RobotIndex(std::size_t{0}), k});
  }
  radio.near_similarity =
      TeamSimilarity(std::vector<std::vector<float>>(kFingerprints, std::vector<float>(kFingerprints, 0)));
  result.robots.resize(1);
  result.robots.front().estimate = Trajectory<SE3>(std::move(way));
  const double before_mib = peak_mib();
  add_access_points(result, mission, radio, {});
  EXPECT_LT(peak_mib() - before_mib, 150);
  EXPECT_TRUE(result.access_points.empty());
  EXPECT_FALSE(result.signals.empty());
}

TEST(AccessPointStage, IsTheSameForAnyNumberOfThreads) {
  const auto numbers = [] {
    std::vector<double> all;
    for (const auto& point : place(26).result.access_points) {
      all.insert(all.end(),
                 {point.position_m.x(), point.position_m.y(), point.exponent, point.covariance(0, 1)});
    }
    return all;
  };
  set_thread_count(1);
  const auto alone = numbers();
  set_thread_count(3);
  const auto together = numbers();
  set_thread_count(0);
  EXPECT_EQ(alone, together);
}

}  // namespace
}  // namespace radioslam
