// A small town from its radio links to its closures, compared with the truth.
#include "radioslam/sim/scenarios/city.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/town_runs.hpp"
#include "radioslam/eval/closures.hpp"

namespace radioslam {
namespace {

using test::error_m;
using test::quick_params;
using test::small_city;

/// A candidate is true if both LiDARs together reach from one keyframe to the other.
PairCounts compare_candidates(const RunResult& result, const Mission& mission, const Truth& truth) {
  std::vector<KeyframeStamps> keyframes;
  for (std::size_t r = 0; r < result.robots.size(); ++r) {
    keyframes.emplace_back();
    for (const auto& row : result.robots[r].estimate) keyframes.back().push_back(row.stamp);
  }
  return count_candidates(keyframes, result.candidates, {truth, 2, lidar_views(mission)});
}

double recall(const PairCounts& counts) {
  return static_cast<double>(counts.true_kept) / static_cast<double>(counts.true_pairs);
}

double false_share_kept(const PairCounts& counts) {
  return static_cast<double>(counts.kept - counts.true_kept) /
         static_cast<double>(counts.pairs - counts.true_pairs);
}

TEST(City, IsMappedAndPrunedByItsRadioLinks) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const auto [mission, truth] = simulate_city(small_city(600), seed);
    const auto result = run_pipeline(mission, quick_params()).result;
    EXPECT_LT(error_m(result, truth), 3.5) << "seed " << seed;
    ASSERT_EQ(result.components.size(), 1U);
    EXPECT_TRUE(result.unplaced.empty());
    const PairCounts counts = compare_candidates(result, mission, truth);
    ASSERT_GT(counts.true_pairs, 50U);
    EXPECT_GE(recall(counts), 0.98) << "seed " << seed;
    EXPECT_LE(false_share_kept(counts), 0.05) << "seed " << seed;
    EXPECT_EQ(result.counts.at("pairs"), static_cast<double>(counts.pairs));
  }
}

TEST(City, AStatedStartThatIsWrongIsNoted) {
  for (const int dimension : {2, 3}) {
    CityParams params = small_city(600);
    params.robots = 3;
    params.dimension = dimension;
    auto [mission, truth] = simulate_city(params, 6);
    for (std::size_t r = 0; r < mission.robots.size(); ++r)
      mission.robots[r].initial_pose = truth.robots[r].poses.front().pose;
    const auto is_noted = [](const Mission& of) {
      const auto notes = run_pipeline(of, quick_params()).result.notes;
      return std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
        return note.find("the stated start of robot") != std::string::npos;
      });
    };
    EXPECT_FALSE(is_noted(mission));
    const SE3 start = *mission.robots[1].initial_pose;
    mission.robots[1].initial_pose = SE3(start.translation() + Eigen::Vector3d(24, -18, 0), start.rotation());
    EXPECT_TRUE(is_noted(mission)) << dimension << " dimensions";
  }
}

TEST(City, TheExhaustiveSearchFindsTheSamePairsInBothModes) {
  const auto [mission, truth] = simulate_city(small_city(600), 3);
  for (const char* mode : {"joint", "link"}) {
    RunParams params = quick_params();
    params.overlap.mode = mode;
    RunOptions options;
    options.overlap_only = true;
    const auto tree = run_pipeline(mission, params, options).result;
    options.search = SearchMethod::kExhaustive;
    const auto all = run_pipeline(mission, params, options).result;
    ASSERT_GT(all.candidates.size(), 50U) << mode;
    ASSERT_EQ(tree.candidates.size(), all.candidates.size()) << mode;
    auto same = all.candidates.begin();
    for (const CandidateResult& candidate : tree.candidates) {
      EXPECT_EQ(candidate.stamp_i, (*same).stamp_i);
      EXPECT_EQ(candidate.stamp_j, (*same).stamp_j);
      EXPECT_EQ(candidate.mahalanobis, (*same).mahalanobis);
      ++same;
    }
    EXPECT_GE(recall(compare_candidates(tree, mission, truth)), 0.95) << mode;
  }
}

std::vector<ClosureResult> matches_of(const RunResult& result) {
  std::vector<ClosureResult> matches;
  for (const auto& closure : result.closures)
    if (closure.kind == ClosureKind::kMatch) matches.push_back(closure);
  return matches;
}

bool is_pruned(const ClosureResult& match) { return match.reason == "the views cannot overlap"; }

double true_distance_m(const PoseMatch& match, const Truth& truth) {
  const auto position = [&](RobotIndex robot, Stamp stamp) {
    return truth.robots[robot.index()].poses.at(stamp)->translation();
  };
  return (position(match.robot_i, match.stamp_i) - position(match.robot_j, match.stamp_j)).norm();
}

/// Matches by outcome. Pruning cannot reject false matches of two close positions; far ones are those beyond
/// range and error.
struct MatchTally {
  std::size_t true_accepted = 0, false_accepted = 0, false_far = 0, false_far_pruned = 0;
};

MatchTally tally(const RunResult& result, const Mission& mission, const Truth& truth) {
  constexpr double kFar_m = 75;
  MatchTally counts;
  const auto matches = matches_of(result);
  EXPECT_EQ(matches.size(), mission.matches.size());
  for (std::size_t k = 0; k < std::min(matches.size(), mission.matches.size()); ++k) {
    const bool accepted = matches[k].status == ClosureStatus::kAccepted;
    if (truth.true_matches[k].value()) {
      counts.true_accepted += accepted;
      continue;
    }
    counts.false_accepted += accepted;
    if (true_distance_m(mission.matches[k], truth) < kFar_m) continue;
    ++counts.false_far;
    counts.false_far_pruned += is_pruned(matches[k]);
  }
  return counts;
}

/// The mission with its true matches only.
Mission only_true_matches(Mission mission, const Truth& truth) {
  std::vector<PoseMatch> kept;
  for (std::size_t k = 0; k < mission.matches.size(); ++k)
    if (truth.true_matches[k].value()) kept.push_back(mission.matches[k]);
  mission.matches = kept;
  return mission;
}

class CityWithAliases : public testing::Test {
 protected:
  static Simulation simulate() {
    CityParams params = small_city(600);
    params.matches.matches_true = 40;
    params.matches.matches_false = 120;
    return simulate_city(params, 4);
  }
};

TEST_F(CityWithAliases, PruningRejectsThemAndTheMapStaysAsGood) {
  const auto [mission, truth] = simulate();
  ASSERT_EQ(mission.matches.size(), 160U);
  const auto result = run_pipeline(mission, quick_params()).result;
  const MatchTally counts = tally(result, mission, truth);
  ASSERT_GT(counts.false_far, 60U);
  EXPECT_EQ(counts.false_far_pruned, counts.false_far);
  EXPECT_EQ(counts.false_accepted, 0U);
  EXPECT_GE(counts.true_accepted, 30U);
  const auto clean = run_pipeline(only_true_matches(mission, truth), quick_params()).result;
  EXPECT_LE(error_m(result, truth), 1.2 * error_m(clean, truth));
}

TEST_F(CityWithAliases, AreNoResultOfARunThatOnlySearchesOverlaps) {
  const Mission mission = simulate().mission;
  ASSERT_FALSE(mission.matches.empty());
  RunOptions options;
  options.overlap_only = true;
  EXPECT_TRUE(matches_of(run_pipeline(mission, quick_params(), options).result).empty());
}

TEST_F(CityWithAliases, AreJudgedAmongAllCandidatesHoweverFewAreListed) {
  const auto [mission, truth] = simulate();
  const auto full = run_pipeline(mission, quick_params()).result;
  RunParams params = quick_params();
  params.overlap.max_listed_candidates = 7;
  const auto few = run_pipeline(mission, params).result;
  EXPECT_EQ(few.candidates.size(), 7U);
  EXPECT_EQ(few.counts.at("candidates"), full.counts.at("candidates"));
  EXPECT_EQ(few.counts.at("candidates_listed"), 7);
  EXPECT_EQ(full.counts.at("candidates_listed"), full.counts.at("candidates"));
  EXPECT_EQ(few.notes.size(), full.notes.size() + 1) << "it says so";
  const auto of_few = matches_of(few), of_full = matches_of(full);
  ASSERT_EQ(of_few.size(), of_full.size());
  for (std::size_t k = 0; k < of_full.size(); ++k) {
    EXPECT_EQ(of_few[k].status, of_full[k].status);
    EXPECT_EQ(of_few[k].reason, of_full[k].reason);
  }
}

TEST_F(CityWithAliases, WithoutPruningTheyAreAdmitted) {
  const auto [mission, truth] = simulate();
  RunOptions options;
  options.pruning = Pruning::kOff;
  const auto result = run_pipeline(mission, quick_params(), options).result;
  for (const auto& match : matches_of(result)) EXPECT_FALSE(is_pruned(match));
  const auto pruned = matches_of(run_pipeline(mission, quick_params()).result);
  EXPECT_GT(std::count_if(pruned.begin(), pruned.end(), is_pruned), 60);
}

}  // namespace
}  // namespace radioslam
