// Two robots between identical pillars: groups of false matches, each larger than the true one, against the
// radio.
#include "radioslam/sim/scenarios/hall.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/town_runs.hpp"

namespace radioslam {
namespace {

using test::error_m;

/// Enough links to determine the frame; every alias is twice as frequent as the truth.
HallParams hall_of_aliases() {
  HallParams params;
  params.radio.links = 16;
  params.odometry.odometry_rate_hz = 2;
  params.matches = AliasedMatchParams{15, 90, 3};
  return params;
}

Mission with_true_matches_only(Mission mission, const Truth& truth) {
  std::vector<PoseMatch> kept;
  for (std::size_t k = 0; k < mission.matches.size(); ++k)
    if (truth.true_matches[k].value_or(false)) kept.push_back(mission.matches[k]);
  mission.matches = kept;
  return mission;
}

std::size_t accepted_matches(const RunResult& result) {
  std::size_t count = 0;
  for (const auto& closure : result.closures)
    count += closure.kind == ClosureKind::kMatch && closure.status == ClosureStatus::kAccepted;
  return count;
}

TEST(Hall, TheRadioRejectsGroupsOfFalseMatchesLargerThanTheTrueOne) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto [mission, truth] = simulate_hall(hall_of_aliases(), seed);
    const auto result = run_pipeline(mission, {}).result;
    const auto by_true = run_pipeline(with_true_matches_only(mission, truth), {}).result;
    Mission without = mission;
    without.matches.clear();
    const auto by_radio = run_pipeline(without, {}).result;
    EXPECT_LE(error_m(result, truth), 1.2 * error_m(by_true, truth) + 0.05) << "seed " << seed;
    EXPECT_LE(error_m(result, truth), 1.1 * error_m(by_radio, truth) + 0.05) << "seed " << seed;
    EXPECT_GE(accepted_matches(result), 10U) << "seed " << seed;
  }
}

/// Matches that agree in large groups; few radio links, whose best alignment alone may be wrong.
TEST(Hall, MatchesAndRadioTogetherFindTheFrameThatNeitherFindsAlone) {
  for (const std::uint64_t seed : {2U, 4U}) {
    const auto [mission, truth] = simulate_hall(HallParams{}, seed);
    EXPECT_LE(error_m(run_pipeline(mission, {}).result, truth), 0.15) << "seed " << seed;
  }
}

/// Two robots that scan a part of the hall.
HallParams scanned_hall() {
  HallParams hall;
  hall.path_length_m = 12;
  hall.speed_mps = 1;
  hall.onboard.lidar.lidar_beams = 8;
  hall.onboard.lidar.lidar_azimuth_steps = 120;
  hall.onboard.lidar.lidar_rotation_hz = 3;
  hall.matches.matches_true = hall.matches.matches_false = 0;
  return hall;
}

class VerificationBudgetOfAHall : public testing::Test {
 protected:
  /// Without a budget all that are proposed are registered.
  void SetUp() override {
    recordings = measure_recordings(mission, {}, {}, timed);
    params.places.least_worth = 0;
  }
  RunResult run(std::optional<std::size_t> budget) {
    RunOptions options;
    if (budget) options.verifications = VerificationBudget{*budget};
    return run_pipeline(mission, recordings, params, options).result;
  }

  Mission mission = simulate_hall(scanned_hall(), 1).mission;
  RunParams params;
  StageClock timed;
  MeasuredRecordings recordings;
};

TEST_F(VerificationBudgetOfAHall, BoundsAllRoundsTogether) {
  const RunResult all = run(std::nullopt);
  ASSERT_GE(all.counts.at("registrations"), 6);
  EXPECT_EQ(all.counts.at("registrations"), all.counts.at("registrations_proposed"));
  EXPECT_LE(all.counts.at("descriptor_bytes"), all.counts.at("descriptor_bytes_all"));
  for (const int rounds : {1, 2, 5}) {
    params.places.rounds = rounds;
    for (const std::size_t most : {0U, 1U, 5U}) {
      const auto counts = run(most).counts;
      EXPECT_EQ(counts.at("registrations"), static_cast<double>(most)) << rounds << " rounds";
      EXPECT_GT(counts.at("registrations_proposed"), static_cast<double>(most));
    }
  }
}

TEST_F(VerificationBudgetOfAHall, ChangesNothingIfItIsLarge) {
  const RunResult all = run(std::nullopt), within = run(1000000);
  EXPECT_EQ(within.counts, all.counts);
  ASSERT_EQ(within.closures.size(), all.closures.size());
  for (std::size_t r = 0; r < all.robots.size(); ++r)
    for (std::size_t k = 0; k < all.robots[r].estimate.size(); ++k)
      EXPECT_EQ(within.robots[r].estimate[k].pose.translation(),
                all.robots[r].estimate[k].pose.translation());
}

/// Rounds that register what is worth most first, and leave what adds next to nothing.
TEST(VerificationsByWorth, AreFewerAndEndAsNear) {
  HallParams hall = scanned_hall();
  hall.path_length_m = 25;
  const auto [mission, truth] = simulate_hall(hall, 2);
  StageClock timed;
  RunParams params;
  const MeasuredRecordings recordings = measure_recordings(mission, params, {}, timed);
  const RunResult by_worth = run_pipeline(mission, recordings, params).result;
  params.places.least_worth = 0;
  const RunResult all = run_pipeline(mission, recordings, params).result;
  EXPECT_LT(by_worth.counts.at("registrations"), 0.7 * all.counts.at("registrations"));
  EXPECT_LT(error_m(by_worth, truth), error_m(all, truth) + 0.02);
}

/// Half of the ranges in a row are those of a signal around a corner.
TEST(Detours, AreFoundByMatchesEvenIfTheyBentTheRadioAlignment) {
  CityParams params = test::small_city(600);
  params.matches = AliasedMatchParams{40, 40, 2};
  auto [mission, truth] = simulate_city(params, 1);
  const double undisturbed_m = error_m(run_pipeline(mission, test::quick_params()).result, truth);
  const std::size_t ranges = mission.ranges.size();
  for (std::size_t k = ranges / 4; k < 3 * ranges / 4; ++k) mission.ranges[k].range_m += 15;
  const auto result = run_pipeline(mission, test::quick_params()).result;
  EXPECT_LE(error_m(result, truth), 1.3 * undisturbed_m + 0.2);
  std::size_t long_ranges_accepted = 0, k = 0;
  for (const auto& closure : result.closures)
    if (closure.kind == ClosureKind::kRange) {
      const bool is_long = k >= ranges / 4 && k < 3 * ranges / 4;
      long_ranges_accepted += is_long && closure.status == ClosureStatus::kAccepted;
      ++k;
    }
  EXPECT_EQ(k, ranges);
  EXPECT_LE(long_ranges_accepted, 1U);
}

TEST(MatchesAlone, PlaceTheTeamAndSaySo) {
  CityParams params = test::small_city(600);
  params.matches = AliasedMatchParams{40, 120, 120};
  const auto [mission, truth] = simulate_city(params, 1);
  Mission without_radio = mission;
  without_radio.ranges.clear();
  without_radio.aoa_measurements.clear();
  const auto result = run_pipeline(without_radio, test::quick_params()).result;
  ASSERT_EQ(result.components.size(), 1U);
  EXPECT_TRUE(result.unplaced.empty());
  const auto by_both = run_pipeline(mission, test::quick_params()).result;
  EXPECT_LE(error_m(result, truth), 1.5 * error_m(by_both, truth));
  ASSERT_FALSE(result.notes.empty());
  EXPECT_NE(result.notes.front().find("stands on matches alone"), std::string::npos);
}

TEST(MatchesAlone, DoNotPlaceATeamWhereTwoGroupsAreAsLarge) {
  CityParams params = test::small_city(600);
  params.matches = AliasedMatchParams{20, 20, 1};
  auto [mission, truth] = simulate_city(params, 1);
  mission.ranges.clear();
  mission.aoa_measurements.clear();
  const auto result = run_pipeline(mission, test::quick_params()).result;
  EXPECT_EQ(result.unplaced.size(), 1U);
  EXPECT_EQ(accepted_matches(result), 0U);
  for (const char* words : {"leave the relative pose", "matches were rejected"})
    EXPECT_TRUE(std::any_of(result.notes.begin(), result.notes.end(), [&](const std::string& note) {
      return note.find(words) != std::string::npos;
    })) << words;
}

}  // namespace
}  // namespace radioslam
