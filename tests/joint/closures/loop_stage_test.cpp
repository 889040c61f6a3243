#include "radioslam/joint/closures/loop_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "joint/closures/block_team.hpp"

namespace radioslam {
namespace {

std::size_t accepted(const BlockTeam::Outcome& out, std::size_t begin, std::size_t end) {
  return static_cast<std::size_t>(
      std::count_if(out.judgements.begin() + static_cast<std::ptrdiff_t>(begin),
                    out.judgements.begin() + static_cast<std::ptrdiff_t>(end),
                    [](const ClosureJudgement& j) { return j.status == ClosureStatus::kAccepted; }));
}

const SE2 kElsewhere({20, -35}, 0.8);

TEST(CloseByLoops, AlignsTwoRobotsAndRejectsWhatContradicts) {
  BlockTeam team(2);
  for (std::size_t k = 40; k < 160; k += 20) team.see(0, k, 1, k - 40);
  for (std::size_t k = 0; k < 3; ++k) team.mistake(0, 20 + 7 * k, 1, 90 - k, kElsewhere);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 0}));
  EXPECT_TRUE(out.alignment.placed[1]);
  EXPECT_EQ(accepted(out, 0, 6), 6u);
  EXPECT_EQ(accepted(out, 6, 9), 0u);
  for (std::size_t k = 40; k < 160; k += 10) EXPECT_LT(team.relative_error_m(out, 0, k, 1, k - 40), 0.7);
}

TEST(CloseByLoops, CountsRepetitionsOfAMeasurementOnce) {
  BlockTeam once(2);
  for (std::size_t k = 40; k < 160; k += 20) once.see(0, k, 1, k - 40);
  BlockTeam often = once;
  often.repeat_last(219);
  const auto one = once.solve(), many = often.solve();
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t k = 0; k < 200; ++k)
      EXPECT_LT((once.pose(one, r, k).inverse() * often.pose(many, r, k)).log().norm(), 1e-9);
  EXPECT_EQ(accepted(many, 0, many.closures.size()), many.closures.size());
}

TEST(CloseByLoops, RepetitionsAloneDoNotPlaceARobot) {
  BlockTeam team(2);
  team.see(0, 100, 1, 60);
  team.repeat_last(219);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 1}));
  EXPECT_FALSE(out.alignment.placed[1]);
  EXPECT_EQ(accepted(out, 0, out.closures.size()), 0u);
  EXPECT_EQ(out.judgements.front().reason, "no group of loops stands out");
}

TEST(CloseByLoops, CorrectsTrajectoriesByTheirOwnLoops) {
  BlockTeam apart(1, 320), looped(1, 320);
  for (std::size_t k = 0; k < 160; k += 16) looped.see(0, k, 0, k + BlockTeam::kRound);
  for (std::size_t k = 0; k < 4; ++k) looped.mistake(0, 10 + 9 * k, 0, 90 - k, kElsewhere);
  const auto out = looped.solve();
  EXPECT_EQ(accepted(out, 0, 10), 10u);
  EXPECT_EQ(accepted(out, 10, 14), 0u);
  EXPECT_LT(looped.largest_error_m(out, 0, 0), 0.6 * apart.largest_error_m(apart.solve(), 0, 0));
}

TEST(CloseByLoops, LeavesRobotsApartWhereGroupsAreEquallyStrong) {
  BlockTeam team(2);
  for (const std::size_t k : {40u, 100u}) team.see(0, k, 1, k - 40);
  for (const std::size_t k : {60u, 130u}) team.mistake(0, k, 1, k - 40, kElsewhere);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 1}));
  EXPECT_EQ(accepted(out, 0, 4), 0u);
}

TEST(CloseByLoops, WithUnitWeightsTheLargestSetJoinsRobotsHoweverWeak) {
  BlockTeam team(2);
  for (const std::size_t k : {40u, 100u}) team.see(0, k, 1, k - 40);
  for (const std::size_t k : {60u, 130u}) team.mistake(0, k, 1, k - 40, kElsewhere);
  const auto few = team.solve({"identity", 100, 5});
  EXPECT_EQ(few.alignment.component, (std::vector<int>{0, 1}));
  EXPECT_EQ(few.judgements.front().reason, "no group of loops stands out");
  EXPECT_EQ(team.solve({"identity", 100, 4}).alignment.component, (std::vector<int>{0, 0}));
  EXPECT_EQ(team.solve({"identity", 1e-6, 4}).alignment.component, (std::vector<int>{0, 1}));
}

TEST(CloseByLoops, ACycleOfThreeRobotsDecidesBetweenGroups) {
  BlockTeam team(3);
  for (const std::size_t k : {45u, 100u}) team.see(0, k, 1, k - 40);
  for (const std::size_t k : {60u, 90u, 130u}) team.mistake(0, k, 1, k - 40, kElsewhere);
  for (const std::size_t k : {85u, 120u, 160u}) team.see(0, k, 2, k - 80);
  for (const std::size_t k : {50u, 90u, 140u}) team.see(1, k, 2, k - 40);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(accepted(out, 0, 2), 2u);
  EXPECT_EQ(accepted(out, 2, 5), 0u);
  EXPECT_EQ(accepted(out, 5, 11), 6u);
  for (const std::size_t k : {45u, 100u}) EXPECT_LT(team.relative_error_m(out, 0, k, 1, k - 40), 0.7);
}

TEST(CloseByLoops, KeepsTrueLoopsWhoseCovariancesAreTooSmallAndSaysSo) {
  BlockTeam team(2);
  for (std::size_t k = 40; k < 199; k += 3) team.see(0, k, 1, k - 40, 3);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 0}));
  EXPECT_GE(accepted(out, 0, out.closures.size()), out.closures.size() * 95 / 100);
  const auto& notes = out.alignment.notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.starts_with("the errors of loop closures are 3.") ||
           note.starts_with("the errors of loop closures are 2.");
  }));
}

}  // namespace
}  // namespace radioslam
