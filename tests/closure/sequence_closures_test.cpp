#include "radioslam/closure/sequence_closures.hpp"

#include <gtest/gtest.h>

#include "closure/sequence_world.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kWay = 15;  // fingerprints: 28 m
constexpr double kHalfWindow_m = 14;
constexpr double kQuarter = 1.5707963267948966;

/// Both robots' whole ways against each other, around their middles.
SequenceFit match_ways(const std::vector<SE2>& a, const std::vector<SE2>& b,
                       const SequenceMatchParams& params = {}) {
  const auto radio = lawful_radio({a, b});
  return match_windows(radio, window_around(radio, a.size() / 2, kHalfWindow_m),
                       window_around(radio, a.size() + b.size() / 2, kHalfWindow_m), params);
}

SE2 middle_to_middle(const std::vector<SE2>& a, const std::vector<SE2>& b) {
  return b[b.size() / 2].inverse() * a[a.size() / 2];
}

TEST(SequenceMatch, TheSameWayGivesThePose) {
  const auto a = bent_way(0, 0, 0.3, kWay, 1.2), b = bent_way(0.6, -0.8, 0.3, kWay, 1.2);
  const SequenceFit fit = match_ways(a, b);
  ASSERT_EQ(fit.verdict, SequenceVerdict::kAccepted);
  EXPECT_LT((middle_to_middle(a, b).inverse() * fit.T_j_i).log().norm(), 0.2);
  EXPECT_LT(fit.residual_m, 2);
}

TEST(SequenceMatch, AWayDrivenBackGivesThePose) {
  const auto a = bent_way(0, 0, 0.3, kWay, 1.2), b = driven_back(a);
  const SequenceFit fit = match_ways(a, b);
  ASSERT_EQ(fit.verdict, SequenceVerdict::kAccepted);
  EXPECT_LT((middle_to_middle(a, b).inverse() * fit.T_j_i).log().norm(), 0.2);
}

TEST(SequenceMatch, AveragedMatchesDrawTogetherTheEstimateDoesNot) {
  // Over a straight way and one that leaves it by 40 degrees, the ends' matches lie short of the truth.
  const auto a = bent_way(0, 0, 0, kWay, 0.7), b = bent_way(0, 0, 0, kWay, 0);
  const SequenceFit fit = match_ways(a, b);
  EXPECT_LT((middle_to_middle(a, b).inverse() * fit.T_j_i).log().norm(), 0.3);
}

TEST(SequenceMatch, ACrossingIsNone) {
  const auto a = bent_way(-14, 0, 0, kWay, 0), b = bent_way(0, -14, kQuarter, kWay, 0);
  EXPECT_EQ(match_ways(a, b).verdict, SequenceVerdict::kResidual);
}

TEST(SequenceMatch, AParallelWayMayBeOnEitherSide) {
  const auto a = bent_way(0, 0, 0, kWay, 0.02), b = bent_way(0, 2.5, 0, kWay, 0.02);
  EXPECT_EQ(match_ways(a, b).verdict, SequenceVerdict::kAmbiguous);
}

TEST(SequenceMatch, ARivalsCostCountsAsMuchAsItIsIndependent) {
  SequenceMatchParams all, fifth;
  all.independent_share = 1;
  fifth.independent_share = 0.2;
  std::size_t open_by_share = 0;
  for (double bend = 0.02; bend < 0.6; bend += 0.02) {
    const auto a = bent_way(0, 0, 0, kWay, bend), b = bent_way(0, 2.5, 0, kWay, bend);
    const auto by_all = match_ways(a, b, all).verdict, by_fifth = match_ways(a, b, fifth).verdict;
    SequenceMatchParams scaled = all;
    scaled.least_rival_margin = all.least_rival_margin / fifth.independent_share;
    EXPECT_EQ(by_fifth, match_ways(a, b, scaled).verdict) << bend;
    if (by_all == SequenceVerdict::kAmbiguous) {
      EXPECT_EQ(by_fifth, SequenceVerdict::kAmbiguous) << bend << ": less evidence";
    }
    if (by_all == SequenceVerdict::kAccepted && by_fifth == SequenceVerdict::kAmbiguous) ++open_by_share;
  }
  EXPECT_GT(open_by_share, 0U);
}

TEST(SequenceMatch, TwoPlacesAreTooFew) {
  const auto a = bent_way(0, 0, 0, 2, 0), b = bent_way(0, 0, 0, kWay, 0);
  EXPECT_EQ(match_ways(a, b).verdict, SequenceVerdict::kTooFewPlaces);
}

TEST(SequenceMatch, WithoutAModelThereIsNoPose) {
  const auto a = bent_way(0, 0, 0, kWay, 1);
  auto radio = lawful_radio({a, a});
  radio.near_model = DistanceModel({}, {});
  EXPECT_EQ(match_windows(radio, window_around(radio, 7, 14), window_around(radio, 22, 14), {}).verdict,
            SequenceVerdict::kNoDistances);
}

TEST(SequenceWindow, HoldsOneRobotsWayAroundItsMiddle) {
  const auto radio = lawful_radio({bent_way(0, 0, 0, 5, 0), bent_way(7, 3, 2, 9, 0)});
  const SequenceWindow window = window_around(radio, 6, 5);
  EXPECT_EQ(window.nodes, (std::vector<std::size_t>{5, 6, 7, 8}));
  EXPECT_NEAR(window.place_m(0, 0), -2, 1e-9);
  EXPECT_NEAR(window.place_m(0, 3), 4, 1e-9);
  EXPECT_NEAR(window.place_m.row(1).norm(), 0, 1e-9);
}

/// The same closed way of 120 m, twice: 60 fingerprints a round.
std::vector<SE2> two_rounds() {
  std::vector<SE2> way{SE2({0, 0}, 0)};
  for (std::size_t k = 1; k <= 120; ++k) way.push_back(way.back() * SE2({2, 0}, k % 15 == 0 ? kQuarter : 0));
  return way;
}

TEST(SequenceCandidates, WithinARobotOnlyAfterAWay) {
  const auto radio = lawful_radio({two_rounds()});
  SequenceClosureParams params;
  params.least_similarity = 0.9;
  const auto candidates = sequence_candidates(radio, params);
  ASSERT_FALSE(candidates.empty());
  for (const auto& c : candidates) EXPECT_EQ((c.node_j - c.node_i) % 60, 0U) << "a whole number of rounds";
  params.least_way_m = 241;
  EXPECT_TRUE(sequence_candidates(radio, params).empty());
}

TEST(SequenceCandidates, OnlyWhereTheyAreAlike) {
  const auto radio = lawful_radio({bent_way(0, 0, 0, 10, 0), bent_way(0, 30, 0, 10, 0)});
  SequenceClosureParams params;
  EXPECT_TRUE(sequence_candidates(radio, params).empty());  // 30 m apart: exp(-1.5)
  params.least_similarity = 0.2;
  EXPECT_FALSE(sequence_candidates(radio, params).empty());
}

TEST(SequenceClosures, AcceptedOnesShareNoPairOfFingerprints) {
  const auto radio = lawful_radio({two_rounds()});
  const SequenceClosureParams params;
  std::vector<SequenceCandidate> accepted;
  for (const auto& closure : propose_sequence_closures(radio, params))
    if (closure.fit.verdict == SequenceVerdict::kAccepted) accepted.push_back(closure.candidate);
  ASSERT_GE(accepted.size(), 3U);
  for (std::size_t a = 0; a < accepted.size(); ++a)
    for (std::size_t b = a + 1; b < accepted.size(); ++b)
      EXPECT_TRUE(way_between_m(radio, accepted[a].node_i, accepted[b].node_i) >= params.window_way_m ||
                  way_between_m(radio, accepted[a].node_j, accepted[b].node_j) >= params.window_way_m);
}

TEST(SequenceClosures, LooseOnesAreRefused) {
  const auto radio = lawful_radio({two_rounds()});
  SequenceClosureParams params;
  params.largest_sigma_yaw_rad = 0.001;
  for (const auto& closure : propose_sequence_closures(radio, params)) {
    EXPECT_NE(closure.fit.verdict, SequenceVerdict::kAccepted);
    EXPECT_NE(reason(closure.fit.verdict), "");
  }
}

TEST(SequenceClosures, AreTheSameForAnyNumberOfThreads) {
  const auto radio = lawful_radio({two_rounds(), bent_way(1, 1, 0, 40, 0.5)});
  const auto numbers = [&] {
    std::vector<double> all;
    for (const auto& [candidate, fit] : propose_sequence_closures(radio, {}))
      for (const double x : {static_cast<double>(candidate.node_i), fit.T_j_i.angle(), fit.residual_m,
                             fit.covariance(0, 0), static_cast<double>(fit.verdict)})
        all.push_back(x);
    return all;
  };
  set_thread_count(1);
  const auto alone = numbers();
  set_thread_count(3);
  const auto together = numbers();
  set_thread_count(0);
  ASSERT_FALSE(alone.empty());
  EXPECT_EQ(alone, together);
}

}  // namespace
}  // namespace radioslam
