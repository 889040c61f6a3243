#include "radioslam/joint/matches/match_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "joint/closures/block_team.hpp"
#include "radioslam/joint/matches/alignment_by_matches.hpp"
#include "radioslam/joint/matches/match_groups.hpp"

namespace radioslam {
namespace {

const SE2 kElsewhere({20, -35}, 0.8);

/// `right` true matches of two robots and `wrong` ones that agree with each other.
BlockTeam two_robots(std::size_t right, std::size_t wrong) {
  BlockTeam team(2);
  for (std::size_t k = 0; k < right; ++k) team.see(0, 40 + 15 * k, 1, 15 * k);
  for (std::size_t k = 0; k < wrong; ++k) team.mistake(0, 20 + 7 * k, 1, 90 - k, kElsewhere);
  return team;
}

CandidateList no_candidates(const JointGraph<SE2>& joint) {
  std::vector<std::vector<Stamp>> stamps;
  for (const RobotVariables& robot : joint.robots) stamps.push_back(robot.stamps);
  return CandidateList(std::move(stamps));
}

bool mentions(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::vector<std::string> reasons(const std::vector<ClosureJudgement>& judgements) {
  std::vector<std::string> result;
  for (const ClosureJudgement& judgement : judgements) result.push_back(judgement.reason);
  return result;
}

TEST(ConsistentGroups, AreDisjointAndLargestFirst) {
  const auto out = two_robots(5, 3).measured();
  const auto groups = consistent_groups(out.joint, out.closures, 2);
  ASSERT_EQ(groups.size(), 2u);
  std::vector<std::size_t> members;
  for (const MatchEnds& ends : groups[0].matches) members.push_back(ends.match);
  EXPECT_EQ(members, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(groups[1].matches.size(), 3u);
}

TEST(PlaceByMatches, JoinsRobotsByAGroupThatStandsOut) {
  const BlockTeam team = two_robots(6, 3);
  auto out = team.measured();
  join_by_matches(out.joint, out.alignment, out.closures);
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 0}));
  EXPECT_TRUE(out.alignment.placed[1]);
  EXPECT_LT(team.relative_error_m(out, 0, 85, 1, 45), 2);  // the odometry's drift since the middle match
  EXPECT_TRUE(mentions(out.alignment.notes, "6 of 9 matches agree with one another"));
}

TEST(PlaceByMatches, LeavesRobotsApartWhereNoGroupStandsOut) {
  auto out = two_robots(4, 3).measured();
  join_by_matches(out.joint, out.alignment, out.closures);
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 1}));
  EXPECT_FALSE(out.alignment.placed[1]);
  EXPECT_TRUE(
      mentions(out.alignment.notes, "the largest group that agrees has 4 of 7 matches, the second 3"));
  select_matches(out.joint, out.alignment, out.closures, out.judgements, no_candidates(out.joint),
                 Pruning::kOn, {});
  for (const std::string& reason : reasons(out.judgements))
    EXPECT_EQ(reason, "no group of matches stands out");
}

TEST(SelectMatches, KeepsTheLargestConsistentSet) {
  const BlockTeam team = two_robots(6, 3);
  auto out = team.measured();
  join_by_matches(out.joint, out.alignment, out.closures);
  const std::size_t before = out.joint.team.graph.relative_poses.size();
  select_matches(out.joint, out.alignment, out.closures, out.judgements, no_candidates(out.joint),
                 Pruning::kOn, {});
  EXPECT_EQ(out.joint.team.graph.relative_poses.size(), before + 6);
  for (std::size_t k = 0; k < 9; ++k)
    EXPECT_EQ(out.judgements[k].reason, k < 6 ? "" : "not consistent with the largest set of matches");
  optimize_with_matches(out.joint, out.judgements, {}, {}, {});
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(out.judgements[k].status, ClosureStatus::kAccepted);
    EXPECT_LT(out.judgements[k].statistic, kPoseChiSquared99<SE2>);
  }
  for (std::size_t k = 40; k < 115; k += 5) EXPECT_LT(team.relative_error_m(out, 0, k, 1, k - 40), 0.7);
}

TEST(SelectMatches, RejectsThoseWithoutOdometryAtTheirTime) {
  auto out = two_robots(6, 0).measured();
  join_by_matches(out.joint, out.alignment, out.closures);
  out.closures[2].stamp_j = Stamp{1000 * kNanosecondsPerSecond};
  select_matches(out.joint, out.alignment, out.closures, out.judgements, no_candidates(out.joint),
                 Pruning::kOn, {});
  EXPECT_EQ(out.judgements[2].reason, "no odometry at its time");
  EXPECT_EQ(std::count_if(out.judgements.begin(), out.judgements.end(),
                          [](const ClosureJudgement& j) { return j.status == ClosureStatus::kAccepted; }),
            5);
}

/// Where other measurements place both robots, only candidates of the overlap search enter, and those that
/// three of them vouch for.
TEST(SelectMatches, AdmitsCandidatesAndWhatTheyVouchFor) {
  for (const std::size_t candidates : {2u, 3u}) {
    auto out = two_robots(6, 1).measured();
    join_by_matches(out.joint, out.alignment, out.closures);
    out.alignment.without_matches = {0, 0};
    CandidateList list = no_candidates(out.joint);
    for (std::size_t k = 0; k < candidates; ++k) {
      const Closure& match = out.closures[k];
      list.push_back({match.robot_i, match.stamp_i, match.robot_j, match.stamp_j});
    }
    select_matches(out.joint, out.alignment, out.closures, out.judgements, list, Pruning::kOn, {});
    for (std::size_t k = 0; k < 7; ++k) {
      const bool enters = k < candidates || (candidates == 3 && k < 6);
      EXPECT_EQ(out.judgements[k].reason, enters ? "" : "the views cannot overlap") << candidates << " " << k;
    }
  }
}

ConsistencyParams unit_weights(double threshold) { return {"identity", threshold, 5}; }

TEST(SelectMatches, WithUnitWeightsMatches50MetresApartAreConsistentAt100AndNotAt20) {
  for (const auto& [threshold, admits] : {std::pair(100.0, true), std::pair(20.0, false)}) {
    BlockTeam team = two_robots(6, 0);
    team.mistake(0, 60, 1, 20, SE2({50, 0}, 0));
    auto out = team.measured();
    join_by_matches(out.joint, out.alignment, out.closures);
    select_matches(out.joint, out.alignment, out.closures, out.judgements, no_candidates(out.joint),
                   Pruning::kOn, {}, nullptr, {}, unit_weights(threshold));
    for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(out.judgements[k].reason, "") << threshold << " " << k;
    const ClosureJudgement& wrong = out.judgements[6];
    EXPECT_EQ(wrong.reason, admits ? "" : "not consistent with the largest set of matches");
    if (!admits) {
      EXPECT_NEAR(std::sqrt(wrong.statistic), 50, 5);
    }
  }
}

TEST(SelectMatches, WithUnitWeightsFewMatchesAreNotAdmitted) {
  for (const std::size_t count : {4u, 5u}) {
    auto out = two_robots(count, 0).measured();
    join_by_matches(out.joint, out.alignment, out.closures);
    select_matches(out.joint, out.alignment, out.closures, out.judgements, no_candidates(out.joint),
                   Pruning::kOn, {}, nullptr, {}, unit_weights(100));
    for (const std::string& reason : reasons(out.judgements))
      EXPECT_EQ(reason, count == 5 ? "" : "too few matches between the robots");
  }
}

TEST(SelectMatches, WithUnitWeightsNoSetVouchesForMatchesThatPruningRejects) {
  auto out = two_robots(6, 0).measured();
  join_by_matches(out.joint, out.alignment, out.closures);
  out.alignment.without_matches = {0, 0};
  CandidateList list = no_candidates(out.joint);
  for (std::size_t k = 0; k < 5; ++k) {
    const Closure& match = out.closures[k];
    list.push_back({match.robot_i, match.stamp_i, match.robot_j, match.stamp_j});
  }
  select_matches(out.joint, out.alignment, out.closures, out.judgements, list, Pruning::kOn, {}, nullptr, {},
                 unit_weights(100));
  EXPECT_EQ(reasons(out.judgements),
            (std::vector<std::string>{"", "", "", "", "", "the views cannot overlap"}));
}

/// Matches of one robot with itself are not compared with each other; the graduated loss judges them.
TEST(OptimizeWithMatches, RejectsWhatTheEstimateContradicts) {
  BlockTeam team(1);
  for (std::size_t k = 0; k < 4; ++k) team.see(0, 5 * k, 0, BlockTeam::kRound + 5 * k);
  team.mistake(0, 10, 0, 100, kElsewhere);
  auto out = team.measured();
  select_matches(out.joint, out.alignment, out.closures, out.judgements, no_candidates(out.joint),
                 Pruning::kOn, {});
  optimize_with_matches(out.joint, out.judgements, {}, {}, {});
  EXPECT_EQ(reasons(out.judgements),
            (std::vector<std::string>{"", "", "", "", "the joint estimate disagrees"}));
}

}  // namespace
}  // namespace radioslam
