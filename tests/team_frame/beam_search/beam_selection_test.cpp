#include "radioslam/team_frame/beam_search/beam_selection.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace radioslam {
namespace {

TeamValues<SE2> team_at(double x_m, double log_evidence) {
  return {{SE2({x_m, 0}, 0)}, {}, {}, log_evidence};
}

std::vector<double> positions(const std::vector<TeamValues<SE2>>& teams) {
  std::vector<double> x_m;
  for (const auto& team : teams) x_m.push_back(team.poses[0].translation().x());
  return x_m;
}

std::vector<double> kept_of(const std::vector<TeamValues<SE2>>& teams, const BeamParams& params,
                            double sigma_m) {
  return positions(different_teams<SE2>(
      teams, params, [&](const TeamValues<SE2>& team) { return std::vector(team.poses.size(), sigma_m); }));
}

TEST(DifferentTeams, KeepsTheBestOfEachNeighbourhood) {
  const std::vector<TeamValues<SE2>> teams{team_at(0, 1), team_at(0.4, 3), team_at(5, 2)};
  const BeamParams params{.beam = 4, .same_map_m = 0.5};
  EXPECT_EQ(kept_of(teams, params, 0), (std::vector<double>{0.4, 5}));
}

TEST(DifferentTeams, MergesWithinTheirUncertainty) {
  const std::vector<TeamValues<SE2>> teams{team_at(0, 2), team_at(5, 1)};
  const BeamParams params{.beam = 4, .same_map_m = 0.5, .same_map_sigmas = 3};
  EXPECT_EQ(kept_of(teams, params, 1).size(), 2u);
  EXPECT_EQ(kept_of(teams, params, 2), (std::vector<double>{0}));
}

TEST(DifferentTeams, KeepsAsManyAsTheBeamHolds) {
  const std::vector<TeamValues<SE2>> teams{team_at(0, 1), team_at(9, 2), team_at(18, 3)};
  EXPECT_EQ(kept_of(teams, {.beam = 2}, 0), (std::vector<double>{18, 9}));
}

TEST(DifferentStarts, KeepsTheCheapestThatDiffer) {
  std::vector<RefinementStart<SE2>> starts{
      {team_at(0, 0), {}, 3}, {team_at(0.1, 0), {}, 1}, {team_at(7, 0), {}, 2}, {team_at(9, 0), {}, 4}};
  const auto kept = different_starts(starts, {.refined_places = 2, .same_map_m = 0.5});
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].cost, 1);
  EXPECT_EQ(kept[1].cost, 2);
}

TEST(BestTeams, KeepsTheBestWithoutNegligibleOnes) {
  const BeamParams params{.beam = 3, .evidence_temperature = 1};
  const std::vector<TeamValues<SE2>> teams{team_at(0, 1), team_at(1, 20), team_at(2, 15), team_at(3, 12),
                                           team_at(4, 11)};
  EXPECT_EQ(positions(best_teams(teams, params)), (std::vector<double>{1, 2, 3}));
  const std::vector<TeamValues<SE2>> far{team_at(0, 1), team_at(1, 20)};
  EXPECT_EQ(positions(best_teams(far, params)), (std::vector<double>{1}));
}

TEST(BestTeams, AreDifferentMaps) {
  const BeamParams params{.beam = 3, .same_map_m = 0.5};
  const std::vector<TeamValues<SE2>> teams{team_at(0, 1), team_at(0.3, 2), team_at(7, 1.5), team_at(7.4, 1)};
  EXPECT_EQ(positions(best_teams(teams, params)), (std::vector<double>{0.3, 7}));
}

/// Of a team whose covariance is singular, say a robot that never moved.
TEST(BestTeams, KeepTeamsWithoutEvidence) {
  const double none = -std::numeric_limits<double>::infinity();
  const std::vector<TeamValues<SE2>> teams{team_at(0, none), team_at(1, none)};
  EXPECT_EQ(best_teams(teams, BeamParams{}).size(), 2U);
  EXPECT_TRUE(best_teams(std::vector<TeamValues<SE2>>{}, BeamParams{}).empty());
}

}  // namespace
}  // namespace radioslam
