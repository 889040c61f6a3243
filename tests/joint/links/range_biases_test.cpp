// Ranges that are too long by a constant per pair of antennas, in whole runs.
#include <algorithm>
#include <array>
#include <cmath>

#include "io/recorded_data.hpp"
#include "pipeline/town_runs.hpp"
#include "radio/ranging/known_biases.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/text/csv.hpp"

namespace radioslam {
namespace {

using test::error_m;
using test::quick_params;

CityParams ranging_city() {
  CityParams params = test::small_city(400);
  params.odometry.odometry_rate_hz = 10;
  params.radio.links = 150;
  params.radio.sigma_range_m = 0.1;
  return params;
}

TEST(RangeBiases, AreFoundAndTakenOff) {
  auto [mission, truth] = simulate_city(ranging_city(), 2);
  const double unbiased_m = error_m(run_pipeline(mission, quick_params()).result, truth);
  for (RangeMeasurement& range : mission.ranges) range.range_m += 0.6;
  RunParams without = quick_params();
  without.range_bias.prior_sigma_m = 0;
  const double biased_m = error_m(run_pipeline(mission, without).result, truth);
  const RunResult result = run_pipeline(mission, quick_params()).result;
  ASSERT_EQ(result.range_biases.size(), 1U);
  const RangeBiasResult& bias = result.range_biases.front();
  EXPECT_EQ(bias.end_i, mission.robots[0].id);
  EXPECT_EQ(bias.end_j, mission.robots[1].id);
  EXPECT_EQ(bias.ranges, mission.ranges.size());
  EXPECT_LT(bias.sigma_m, 0.1);
  EXPECT_LT(std::abs(bias.bias_m - 0.6), 3 * bias.sigma_m);
  EXPECT_LT(error_m(result, truth), unbiased_m + (biased_m - unbiased_m) / 2);
  EXPECT_GT(biased_m, 1.5 * unbiased_m) << "or the test shows nothing";
}

TEST(RangeBiases, AreNotSeenWhereThereAreNone) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto [mission, truth] = simulate_city(ranging_city(), seed);
    const RunResult result = run_pipeline(mission, quick_params()).result;
    EXPECT_TRUE(result.range_biases.empty()) << "seed " << seed;
    if (seed != 1U) continue;
    RunParams without = quick_params();
    without.range_bias.prior_sigma_m = 0;
    const RunResult plain = run_pipeline(mission, without).result;
    for (std::size_t r = 0; r < result.robots.size(); ++r)
      EXPECT_EQ(result.robots[r].estimate.back().pose.translation(),
                plain.robots[r].estimate.back().pose.translation());
  }
}

TEST(RangeBiases, AreNotSeenInErrorsThatComeInRuns) {
  constexpr double kStay = 0.9, kSigma_m = 0.15;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    auto [mission, truth] = simulate_city(ranging_city(), seed);
    Rng rng(seed);
    double late_m = kSigma_m * rng.normal();
    for (RangeMeasurement& range : mission.ranges) {
      range.range_m += late_m;
      late_m = kStay * late_m + kSigma_m * std::sqrt(1 - kStay * kStay) * rng.normal();
    }
    EXPECT_TRUE(run_pipeline(mission, quick_params()).result.range_biases.empty()) << "seed " << seed;
  }
}

TEST(RangeBiases, AreNotSeenInDetours) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    auto [mission, truth] = simulate_city(ranging_city(), seed);
    const double direct_m = error_m(run_pipeline(mission, quick_params()).result, truth);
    Rng rng(seed);
    for (std::size_t k = 0; k < mission.ranges.size(); ++k)
      if (k % 5 < 3) mission.ranges[k].range_m += 2 + 20 * rng.uniform();
    const RunResult result = run_pipeline(mission, quick_params()).result;
    EXPECT_TRUE(result.range_biases.empty()) << "seed " << seed;
    EXPECT_LT(error_m(result, truth), 1.5 * direct_m + 0.2) << "seed " << seed;
  }
}

constexpr std::size_t kRobots = 4, kPairs = 6;
constexpr std::array<std::array<std::size_t, 2>, kPairs> kEnds{
    {{3, 0}, {3, 1}, {3, 2}, {2, 1}, {2, 0}, {1, 0}}};

struct Recording {
  Mission mission;
  Truth truth;
  std::array<double, kPairs> bias_m{};  ///< from motion capture
};

/// Four robots under motion capture: its poses with drift added as odometry, and their raw ranges.
Recording read_turtlebots(const std::filesystem::path& path) {
  const Text text = read_text(path);
  CsvReader csv(text, {{"x1", "y1", "yaw1", "x3", "y3", "yaw3", "x4", "y4", "yaw4", "x5", "y5", "yaw5",
                        "range_5_1", "range_5_3", "range_5_4", "range_4_3", "range_4_1", "range_3_1"}});
  constexpr double kStep_s = 0.1;
  std::array<std::vector<StampedPose<SE3>>, kRobots> truth, odometry;
  std::vector<test::KnownRange> known;
  Recording recording;
  Rng rng(7);
  for (std::size_t row = 0; csv.next(); ++row) {
    const Stamp stamp = Stamp::from_seconds(kStep_s * static_cast<double>(row));
    for (std::size_t r = 0; r < kRobots; ++r) {
      const SE2 pose(Eigen::Vector2d(csv.number(3 * r), csv.number(3 * r + 1)), csv.number(3 * r + 2));
      truth[r].push_back({stamp, as_se3(pose, 0)});
      if (row == 0) {
        odometry[r].push_back({stamp, SE3()});
        continue;
      }
      const SE3 step = truth[r][row - 1].pose.inverse() * truth[r][row].pose;
      const double path_m = step.translation().norm();
      const SE2 noise({0.02 * std::sqrt(path_m) * rng.normal(), 0.02 * std::sqrt(path_m) * rng.normal()},
                      0.005 * std::sqrt(path_m) * rng.normal());
      odometry[r].push_back({stamp, odometry[r].back().pose * step * as_se3(noise, 0)});
    }
    for (std::size_t pair = 0; pair < kPairs; ++pair) {
      const double range_m = csv.number(3 * kRobots + pair);
      if (range_m <= 0) continue;  // no range received
      const auto [i, j] = kEnds[pair];
      known.push_back(
          {pair, range_m, (truth[i].back().pose.translation() - truth[j].back().pose.translation()).norm()});
      RangeMeasurement range{stamp, {}, {}, range_m, 0.1};
      range.i.robot = RobotIndex(i);
      range.j.robot = RobotIndex(j);
      if (row % 5 == 0) recording.mission.ranges.push_back(range);
    }
  }
  const auto biases = test::known_biases(known, kPairs);
  for (std::size_t pair = 0; pair < kPairs; ++pair) recording.bias_m[pair] = biases[pair].bias_m;
  for (std::size_t r = 0; r < kRobots; ++r) {
    Robot robot;
    robot.id = "r" + std::to_string(r);
    robot.odometry = Trajectory<SE3>(odometry[r]);
    recording.mission.robots.push_back(std::move(robot));
    recording.truth.robots.push_back({recording.mission.robots.back().id, Trajectory<SE3>(truth[r])});
  }
  return recording;
}

/// Index of the bias between two robots.
std::size_t bias_of(const RunResult& result, const std::array<std::size_t, 2>& ends) {
  const std::string high = result.robots[ends[0]].id, low = result.robots[ends[1]].id;
  const auto found = std::find_if(result.range_biases.begin(), result.range_biases.end(),
                                  [&](const auto& bias) { return bias.end_i == low && bias.end_j == high; });
  return static_cast<std::size_t>(found - result.range_biases.begin());
}

TEST(RangeBiases, OfFourTurtlebotsAreThoseAgainstMotionCapture) {
  RADIOSLAM_RECORDED(path, "tiers/csv/4robots_data_01.csv");
  const Recording recording = read_turtlebots(path);
  RunParams without;
  without.range_bias.prior_sigma_m = 0;
  const double biased_m = error_m(run_pipeline(recording.mission, without).result, recording.truth);
  const RunResult result = run_pipeline(recording.mission, {}).result;
  RecordProperty("ate_m", std::to_string(error_m(result, recording.truth)));
  EXPECT_LT(error_m(result, recording.truth), 0.6 * biased_m);
  ASSERT_EQ(result.range_biases.size(), kPairs);
  for (std::size_t pair = 0; pair < kPairs; ++pair) {
    const RangeBiasResult& bias = result.range_biases[bias_of(result, kEnds[pair])];
    EXPECT_NEAR(bias.bias_m, recording.bias_m[pair], 0.2) << bias.end_i << " to " << bias.end_j;
    EXPECT_GT(bias.bias_m, bias.sigma_m);
    EXPECT_GT(bias.ranges, 200U);
  }
}

}  // namespace
}  // namespace radioslam
