#include "radioslam/closure/sequence_closures.hpp"

#include <gtest/gtest.h>

#include "closure/sequence_world.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kFingerprints = 15;  // fingerprints: 28 m
constexpr double kHalfWindow_m = 14;
constexpr double kQuarter = 1.5707963267948966;

/// Matches both robots' whole paths, with windows around their middles.
SequenceFit match_paths(const std::vector<SE2>& a, const std::vector<SE2>& b,
                        const SequenceMatchParams& params = {}) {
  const auto radio = lawful_radio({a, b});
  return match_windows(radio, window_around(radio, a.size() / 2, kHalfWindow_m),
                       window_around(radio, a.size() + b.size() / 2, kHalfWindow_m), params);
}

SE2 middle_to_middle(const std::vector<SE2>& a, const std::vector<SE2>& b) {
  return b[b.size() / 2].inverse() * a[a.size() / 2];
}

TEST(SequenceMatch, TheSamePathGivesThePose) {
  const auto a = bent_way(0, 0, 0.3, kFingerprints, 1.2), b = bent_way(0.6, -0.8, 0.3, kFingerprints, 1.2);
  const SequenceFit fit = match_paths(a, b);
  ASSERT_EQ(fit.status, SequenceStatus::kAccepted);
  EXPECT_LT((middle_to_middle(a, b).inverse() * fit.T_j_i).log().norm(), 0.2);
  EXPECT_LT(fit.residual_m, 2);
}

TEST(SequenceMatch, AReversedPathGivesThePose) {
  const auto a = bent_way(0, 0, 0.3, kFingerprints, 1.2), b = driven_back(a);
  const SequenceFit fit = match_paths(a, b);
  ASSERT_EQ(fit.status, SequenceStatus::kAccepted);
  EXPECT_LT((middle_to_middle(a, b).inverse() * fit.T_j_i).log().norm(), 0.2);
}

TEST(SequenceMatch, AveragedMatchesAreBiasedTheEstimateIsNot) {
  // On a straight path and one that departs from it by 40 degrees, averaging pulls the ends' matches inwards.
  const auto a = bent_way(0, 0, 0, kFingerprints, 0.7), b = bent_way(0, 0, 0, kFingerprints, 0);
  const SequenceFit fit = match_paths(a, b);
  EXPECT_LT((middle_to_middle(a, b).inverse() * fit.T_j_i).log().norm(), 0.3);
}

TEST(SequenceMatch, ACrossingIsNone) {
  const auto a = bent_way(-14, 0, 0, kFingerprints, 0), b = bent_way(0, -14, kQuarter, kFingerprints, 0);
  EXPECT_EQ(match_paths(a, b).status, SequenceStatus::kResidual);
}

TEST(SequenceMatch, AParallelPathMayBeOnEitherSide) {
  const auto a = bent_way(0, 0, 0, kFingerprints, 0.02), b = bent_way(0, 2.5, 0, kFingerprints, 0.02);
  EXPECT_EQ(match_paths(a, b).status, SequenceStatus::kAmbiguous);
}

TEST(SequenceMatch, AnAlternativesCostIsScaledToIndependentPairs) {
  SequenceMatchParams all, fifth;
  all.effective_sample_ratio = 1;
  fifth.effective_sample_ratio = 0.2;
  std::size_t open_by_ratio = 0;
  for (double bend = 0.02; bend < 0.6; bend += 0.02) {
    const auto a = bent_way(0, 0, 0, kFingerprints, bend), b = bent_way(0, 2.5, 0, kFingerprints, bend);
    const auto by_all = match_paths(a, b, all).status, by_fifth = match_paths(a, b, fifth).status;
    SequenceMatchParams scaled = all;
    scaled.min_alternative_margin = all.min_alternative_margin / fifth.effective_sample_ratio;
    EXPECT_EQ(by_fifth, match_paths(a, b, scaled).status) << bend;
    if (by_all == SequenceStatus::kAmbiguous) {
      EXPECT_EQ(by_fifth, SequenceStatus::kAmbiguous) << bend << ": less evidence";
    }
    if (by_all == SequenceStatus::kAccepted && by_fifth == SequenceStatus::kAmbiguous) ++open_by_ratio;
  }
  EXPECT_GT(open_by_ratio, 0U);
}

TEST(SequenceMatch, TwoPlacesAreTooFew) {
  const auto a = bent_way(0, 0, 0, 2, 0), b = bent_way(0, 0, 0, kFingerprints, 0);
  EXPECT_EQ(match_paths(a, b).status, SequenceStatus::kTooFewMatches);
}

TEST(SequenceMatch, WithoutAModelThereIsNoPose) {
  const auto a = bent_way(0, 0, 0, kFingerprints, 1);
  auto radio = lawful_radio({a, a});
  radio.near_model = DistanceModel({}, {});
  EXPECT_EQ(match_windows(radio, window_around(radio, 7, 14), window_around(radio, 22, 14), {}).status,
            SequenceStatus::kNoDistances);
}

TEST(SequenceWindow, HoldsOneRobotsPathAroundItsMiddle) {
  const auto radio = lawful_radio({bent_way(0, 0, 0, 5, 0), bent_way(7, 3, 2, 9, 0)});
  const SequenceWindow window = window_around(radio, 6, 5);
  EXPECT_EQ(window.nodes, (std::vector<std::size_t>{5, 6, 7, 8}));
  EXPECT_NEAR(window.position_m(0, 0), -2, 1e-9);
  EXPECT_NEAR(window.position_m(0, 3), 4, 1e-9);
  EXPECT_NEAR(window.position_m.row(1).norm(), 0, 1e-9);
}

/// The same closed path of 120 m, twice: 60 fingerprints per round.
std::vector<SE2> two_rounds() {
  std::vector<SE2> path{SE2({0, 0}, 0)};
  for (std::size_t k = 1; k <= 120; ++k)
    path.push_back(path.back() * SE2({2, 0}, k % 15 == 0 ? kQuarter : 0));
  return path;
}

TEST(SequenceCandidates, WithinARobotOnlyBeyondAPathLength) {
  const auto radio = lawful_radio({two_rounds()});
  SequenceClosureParams params;
  params.min_similarity = 0.9;
  const auto candidates = sequence_candidates(radio, params);
  ASSERT_FALSE(candidates.empty());
  for (const auto& c : candidates) EXPECT_EQ((c.node_j - c.node_i) % 60, 0U) << "a whole number of rounds";
  params.min_path_m = 241;
  EXPECT_TRUE(sequence_candidates(radio, params).empty());
}

TEST(SequenceCandidates, OnlyWhereTheyAreSimilar) {
  const auto radio = lawful_radio({bent_way(0, 0, 0, 10, 0), bent_way(0, 30, 0, 10, 0)});
  SequenceClosureParams params;
  EXPECT_TRUE(sequence_candidates(radio, params).empty());  // 30 m apart: exp(-1.5)
  params.min_similarity = 0.2;
  EXPECT_FALSE(sequence_candidates(radio, params).empty());
}

TEST(SequenceClosures, AcceptedOnesHaveNoPairOfFingerprintsInCommon) {
  const auto radio = lawful_radio({two_rounds()});
  const SequenceClosureParams params;
  std::vector<SequenceCandidate> accepted;
  for (const auto& closure : propose_sequence_closures(radio, params))
    if (closure.fit.status == SequenceStatus::kAccepted) accepted.push_back(closure.candidate);
  ASSERT_GE(accepted.size(), 3U);
  for (std::size_t a = 0; a < accepted.size(); ++a)
    for (std::size_t b = a + 1; b < accepted.size(); ++b)
      EXPECT_TRUE(path_between_m(radio, accepted[a].node_i, accepted[b].node_i) >= params.window_path_m ||
                  path_between_m(radio, accepted[a].node_j, accepted[b].node_j) >= params.window_path_m);
}

TEST(SequenceClosures, UncertainOnesAreRejected) {
  const auto radio = lawful_radio({two_rounds()});
  SequenceClosureParams params;
  params.max_sigma_yaw_rad = 0.001;
  for (const auto& closure : propose_sequence_closures(radio, params)) {
    EXPECT_NE(closure.fit.status, SequenceStatus::kAccepted);
    EXPECT_NE(reason(closure.fit.status), "");
  }
}

std::vector<double> numbers_of(const std::vector<SequenceClosure>& closures) {
  std::vector<double> all;
  for (const auto& [candidate, fit] : closures)
    for (const double x :
         {static_cast<double>(candidate.node_i), static_cast<double>(candidate.node_j), candidate.similarity,
          fit.T_j_i.translation().x(), fit.T_j_i.translation().y(), fit.T_j_i.angle(), fit.residual_m,
          fit.covariance.determinant(), static_cast<double>(fit.status)})
      all.push_back(x);
  return all;
}

TEST(SequenceClosures, MatchedBeforeAreTheSameAndNotMatchedAgain) {
  const auto rounds = two_rounds(), way = bent_way(1, 1, 0, 60, 0.5);
  const auto known = [&](std::size_t a, std::size_t b) {
    return lawful_radio({{rounds.begin(), rounds.begin() + static_cast<std::ptrdiff_t>(a)},
                         {way.begin(), way.begin() + static_cast<std::ptrdiff_t>(b)}});
  };
  auto radio = known(10, 10);
  auto matched = match_sequences(radio, {});
  std::size_t taken = 0;
  for (const auto& [a, b] : {std::pair(60, 10), {64, 31}, {100, 33}, {100, 59}, {121, 60}}) {
    const auto more = known(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
    const auto from_nothing = match_sequences(more, {});
    const EarlierSequences earlier{radio, matched};
    auto next = match_sequences(more, {}, &earlier);
    EXPECT_EQ(numbers_of(next), numbers_of(from_nothing)) << a << " " << b;
    auto marked = matched;
    for (SequenceClosure& closure : marked) closure.fit.residual_m = -1;
    const EarlierSequences earlier_marked{radio, marked};
    for (const SequenceClosure& closure : match_sequences(more, {}, &earlier_marked))
      taken += closure.fit.residual_m < 0 ? 1U : 0U;
    radio = more;
    matched = std::move(next);
  }
  EXPECT_GT(taken, matched.size() / 2);
}

TEST(SequenceClosures, AreTheSameForAnyNumberOfThreads) {
  const auto radio = lawful_radio({two_rounds(), bent_way(1, 1, 0, 40, 0.5)});
  const auto numbers = [&] {
    std::vector<double> all;
    for (const auto& [candidate, fit] : propose_sequence_closures(radio, {}))
      for (const double x : {static_cast<double>(candidate.node_i), fit.T_j_i.angle(), fit.residual_m,
                             fit.covariance(0, 0), static_cast<double>(fit.status)})
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
