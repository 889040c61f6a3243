// Exchanges round one corner continue each other, others do not.
#include "radioslam/team_frame/line_of_sight/detour_continuity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr DetourModel kModel{200, 10, 0.8};
constexpr double kSigma_m = 0.5, kSigma_rad = 0.1;

/// Robot a drives east towards a corner at the origin, b north away from it; both start 40 m from it. Each
/// sees the signal come from the corner, one straight ahead and the other straight behind.
TeamGraph<SE2> round_a_corner(std::size_t exchanges, double gap_s) {
  TeamGraph<SE2> team;
  team.segments = {{"a", 0, exchanges, {}}, {"b", exchanges, exchanges, {}}};
  const auto driven_a = [&](std::size_t k) { return 3.0 * gap_s * static_cast<double>(k) / 5; };
  const auto driven_b = [&](std::size_t k) { return 2 * driven_a(k); };
  // Each in a frame of its own, in which it does not start along x.
  for (std::size_t k = 0; k < exchanges; ++k)
    team.graph.poses.push_back(SE2({3, 1}, 1.2) * SE2({driven_a(k), 0}, 0));
  for (std::size_t k = 0; k < exchanges; ++k)
    team.graph.poses.push_back(SE2({-8, 2}, -2) * SE2({driven_b(k), 0}, 0));
  for (std::size_t k = 0; k < exchanges; ++k) {
    for (TrajectorySegment& segment : team.segments)
      segment.stamps.push_back(Stamp::from_seconds(gap_s * static_cast<double>(k)));
    const PoseId a(k), b(exchanges + k);
    RangeFactor<SE2> range;
    range.i.pose = a;
    range.j.pose = b;
    range.range_m = (40 - driven_a(k)) + (40 + driven_b(k));
    range.sigma_m = kSigma_m;
    team.graph.ranges.push_back(range);
    for (const bool at_a : {true, false}) {
      AmbiguousBearing<SE2> bearing;
      bearing.i = at_a ? a : b;
      bearing.j.pose = at_a ? b : a;
      bearing.paths = {{{at_a ? 1.0 : -1.0, 0}, kSigma_rad}};
      team.bearings.push_back(bearing);
    }
  }
  return team;
}

std::vector<double> densities(const TeamGraph<SE2>& team) {
  return detour_densities(team, std::vector<double>(team.bearings.size(), 1), kModel);
}

TEST(DetourContinuity, TheFirstExchangeIsUniform) {
  EXPECT_DOUBLE_EQ(densities(round_a_corner(2, 1))[0], 1 / kModel.span_m);
}

TEST(DetourContinuity, ExchangesRoundOneCornerContinueEachOther) {
  auto team = round_a_corner(3, 1);
  const auto same = densities(team);
  for (auto& bearing : team.bearings)
    if (bearing.i == PoseId(2)) bearing.paths[0].direction = {0, 1};
  team.graph.ranges[2].range_m += 30;
  const auto another = densities(team);
  EXPECT_GT(same[1] * kModel.span_m, 500) << "a predicted range and two predicted angles";
  EXPECT_GT(same[2] * kModel.span_m, 500);
  EXPECT_EQ(another[1], same[1]);
  EXPECT_LT(another[2] * kModel.span_m, 1);
}

TEST(DetourContinuity, AfterALongPauseNothingContinues) {
  EXPECT_NEAR(densities(round_a_corner(2, 100))[1] * kModel.span_m, 1, 0.05);
}

/// Without angles after the first exchange the density is one of the range alone.
TEST(DetourContinuity, TheDensityOfARangeIntegratesToOne) {
  auto team = round_a_corner(2, 1);
  team.bearings.resize(2);
  constexpr double kStep_m = 0.1;
  double sum = 0;
  for (int k = 0; k < 2000; ++k) {
    team.graph.ranges[1].range_m = kStep_m * (k + 0.5);
    sum += kStep_m * densities(team)[1];
  }
  EXPECT_NEAR(sum, 1, 1e-3);
}

/// Relative to uniform angles, the mean over all angles is the density of the range.
TEST(DetourContinuity, TheDensityOfAnglesIntegratesToOne) {
  auto team = round_a_corner(2, 1);
  auto range_only = team;
  range_only.bearings.resize(2);
  constexpr int kSteps = 120;
  double sum = 0;
  for (int a = 0; a < kSteps; ++a)
    for (int b = 0; b < kSteps; ++b) {
      const double at_a = 2 * kPi * a / kSteps, at_b = 2 * kPi * b / kSteps;
      team.bearings[2].paths[0].direction = {std::cos(at_a), std::sin(at_a)};
      team.bearings[3].paths[0].direction = {std::cos(at_b), std::sin(at_b)};
      sum += densities(team)[1];
    }
  EXPECT_NEAR(sum / (kSteps * kSteps) / densities(range_only)[1], 1, 1e-3);
}

TEST(DetourContinuity, DoesNotDependOnWhichEndMeasuredTheRange) {
  auto team = round_a_corner(3, 1);
  const auto before = densities(team);
  for (auto& range : team.graph.ranges) std::swap(range.i, range.j);
  std::swap(team.bearings[0], team.bearings[1]);
  EXPECT_EQ(densities(team), before);
}

TEST(DetourContinuity, FurtherRangesOfAnExchangeDoNotCountItsAnglesAgain) {
  auto team = round_a_corner(3, 2);
  const auto once = densities(team);
  for (std::size_t k = 0; k < 3; ++k) {  // by another antenna
    team.graph.ranges.push_back(team.graph.ranges[k]);
    team.graph.ranges.back().range_m += 0.3;
  }
  const auto twice = densities(team);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(twice[k], once[k]);
    EXPECT_LT(twice[3 + k], 0.5) << "that of one range";
    EXPECT_GT(twice[3 + k], 0.1);
  }
}

TEST(DetourContinuity, TheLinksOfAnExchangeNeedNotShareATime) {
  auto team = round_a_corner(3, 2);
  auto later = team;
  for (auto& stamp : later.segments[0].stamps) stamp.ns += 200'000'000;
  const auto together = densities(team), apart = densities(later);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(apart[k], together[k], 1e-9 * together[k]);
}

TEST(DetourContinuity, DoesNotDependOnTheEstimate) {
  auto team = round_a_corner(3, 1);
  for (std::size_t k = 1; k < team.graph.poses.size(); ++k) {
    if (k == 3) continue;
    const SE2 T_i_j = team.graph.poses[k - 1].inverse() * team.graph.poses[k];
    team.graph.relative_poses.push_back({PoseId(k - 1), PoseId(k), T_i_j});
  }
  const auto before = densities(team);
  for (std::size_t k = 1; k < 3; ++k) team.graph.poses[k] = SE2({1, 2}, 0.3) * team.graph.poses[k];
  const auto bent = densities(team);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(bent[k], before[k], 1e-9 * before[k]);
}

TEST(DetourContinuity, RangesAloneContinueWithinTheMotion) {
  auto team = round_a_corner(2, 5);
  team.bearings.clear();
  const double near = densities(team)[1];
  team.graph.ranges[1].range_m += 60;
  EXPECT_GT(near * kModel.span_m, 2);
  EXPECT_LT(densities(team)[1] * kModel.span_m, 1);
}

}  // namespace
}  // namespace radioslam
