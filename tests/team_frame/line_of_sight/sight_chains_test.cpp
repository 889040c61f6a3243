// The forward and the backward pass against the sum over all sequences of states.
#include "radioslam/team_frame/line_of_sight/sight_chains.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kLinks = 6;
constexpr std::array<double, kLinks> kStamps_s{0, 1, 1, 4, 30, 33};
constexpr double kObstructedShare = 0.3, kCorrelationTime_s = 5;

/// Two robots whose ranges have these stamps, listed in another order.
TeamGraph<SE2> linked_team() {
  TeamGraph<SE2> team;
  team.graph.poses.resize(2 * kLinks);
  team.segments = {{"a", 0, kLinks, {}}, {"b", kLinks, kLinks, {}}};
  for (TrajectorySegment& segment : team.segments)
    for (const double t : kStamps_s) segment.stamps.push_back(Stamp::from_seconds(t));
  for (std::size_t n = 0; n < kLinks; ++n) {
    const std::size_t k = kLinks - 1 - n;
    RangeFactor<SE2> range;
    range.i.pose = PoseId(n % 2 == 0 ? k : kLinks + k);
    range.j.pose = PoseId(n % 2 == 0 ? kLinks + k : k);
    team.graph.ranges.push_back(range);
  }
  return team;
}

std::vector<SightDensities> some_densities() {
  Rng rng(3);
  std::vector<SightDensities> densities;
  for (std::size_t k = 0; k < kLinks; ++k) {
    const double in_sight = rng.uniform(0.01, 2);
    densities.push_back({in_sight, rng.uniform(0.01, 2)});
  }
  return densities;
}

/// Probability of a sequence of states, bit k of it being 1 where link k in time is obstructed, with its
/// measurements.
double joint_density(unsigned states, const std::vector<SightDensities>& densities) {
  const auto is_obstructed = [&](std::size_t k) { return (states >> k & 1U) != 0; };
  const auto share = [](bool obstructed) { return obstructed ? kObstructedShare : 1 - kObstructedShare; };
  double density = share(is_obstructed(0));
  for (std::size_t k = 0; k < kLinks; ++k) {
    const SightDensities& own = densities[kLinks - 1 - k];
    density *= is_obstructed(k) ? own.obstructed : own.in_sight;
    if (k == 0) continue;
    const double kept = std::exp(-(kStamps_s[k] - kStamps_s[k - 1]) / kCorrelationTime_s);
    density *= share(is_obstructed(k)) * (1 - kept) + (is_obstructed(k) == is_obstructed(k - 1) ? kept : 0);
  }
  return density;
}

TEST(SightChains, AreTheSumOverAllSequencesOfStates) {
  const auto densities = some_densities();
  double all = 0;
  std::array<double, kLinks> in_sight{};
  for (unsigned states = 0; states < 1U << kLinks; ++states) {
    const double density = joint_density(states, densities);
    all += density;
    for (std::size_t k = 0; k < kLinks; ++k)
      if ((states >> k & 1U) == 0) in_sight[k] += density;
  }
  const SightChains chains(linked_team(), kCorrelationTime_s);
  EXPECT_NEAR(chains.log_likelihood(densities, kObstructedShare), std::log(all), 1e-12);
  std::vector<double> posterior;
  EXPECT_NEAR(chains.smooth(densities, kObstructedShare, posterior), std::log(all), 1e-12);
  for (std::size_t k = 0; k < kLinks; ++k)
    EXPECT_NEAR(posterior[kLinks - 1 - k], in_sight[k] / all, 1e-12) << k;
  EXPECT_NEAR(posterior[kLinks - 2], posterior[kLinks - 3], 1e-12) << "the same time, the same state";
}

TEST(SightChains, PairsOfRobotsAreIndependent) {
  TeamGraph<SE2> team = linked_team();
  team.graph.poses.emplace_back();
  team.segments.push_back({"c", 2 * kLinks, 1, {Stamp{}}});
  RangeFactor<SE2> other;
  other.i.pose = PoseId(0);
  other.j.pose = PoseId(2 * kLinks);
  team.graph.ranges.push_back(other);
  auto densities = some_densities();
  const double before =
      SightChains(linked_team(), kCorrelationTime_s).log_likelihood(densities, kObstructedShare);
  densities.push_back({1e-3, 0.5});
  EXPECT_NEAR(SightChains(team, kCorrelationTime_s).log_likelihood(densities, kObstructedShare),
              before + std::log(0.7e-3 + 0.15), 1e-12);
}

TEST(SightChains, GiveTheSameBytesOnAnyNumberOfThreads) {
  TeamGraph<SE2> team = linked_team();
  for (std::size_t robot = 2; robot < 300; ++robot) {
    team.segments.push_back({"c" + std::to_string(robot), team.graph.poses.size(), 1, {Stamp{}}});
    team.graph.ranges.push_back({});
    team.graph.ranges.back().i.pose = PoseId(robot % kLinks);
    team.graph.ranges.back().j.pose = PoseId(team.graph.poses.size());
    team.graph.poses.emplace_back();
  }
  Rng rng(5);
  std::vector<SightDensities> densities(team.graph.ranges.size());
  for (SightDensities& d : densities) d = {rng.uniform(0.01, 2), rng.uniform(0.01, 2)};
  const SightChains chains(team, kCorrelationTime_s);
  std::vector<double> alone, together;
  set_thread_count(1);
  const double by_one = chains.smooth(densities, kObstructedShare, alone);
  set_thread_count(3);
  EXPECT_EQ(chains.smooth(densities, kObstructedShare, together), by_one);
  EXPECT_EQ(chains.log_likelihood(densities, kObstructedShare), by_one);
  EXPECT_EQ(together, alone);
  set_thread_count(0);
}

TEST(SightChains, WithoutObstructionsEveryLinkIsInSight) {
  const auto densities = some_densities();
  std::vector<double> posterior;
  double expected = 0;
  for (const auto& d : densities) expected += std::log(d.in_sight);
  EXPECT_NEAR(SightChains(linked_team(), kCorrelationTime_s).smooth(densities, 0, posterior), expected,
              1e-12);
  for (const double p : posterior) EXPECT_EQ(p, 1);
}

}  // namespace
}  // namespace radioslam
