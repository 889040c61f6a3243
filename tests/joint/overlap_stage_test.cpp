// Candidates of several team alignments.
#include "radioslam/joint/overlap_stage.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

CandidateResult candidate(double t_i_s, double t_j_s, double mahalanobis) {
  return {RobotIndex(0), Stamp::from_seconds(t_i_s), RobotIndex(1), Stamp::from_seconds(t_j_s), 5,
          mahalanobis};
}

OverlapStage stage(std::vector<CandidateResult> candidates, std::size_t evaluated) {
  OverlapStage result;
  result.candidates = std::move(candidates);
  result.counts.pairs = 100;
  result.counts.kept = result.candidates.size();
  result.counts.distances_evaluated = evaluated;
  result.searched = true;
  return result;
}

TEST(OverlapStage, CandidatesOfAlignmentsAreTheirUnion) {
  OverlapStage all = stage({candidate(1, 1, 0.5), candidate(2, 1, 1.5)}, 7);
  add_candidates(all, stage({candidate(1, 2, 1), candidate(2, 1, 0.2)}, 5));
  ASSERT_EQ(all.candidates.size(), 3U);
  EXPECT_EQ(all.candidates[0].mahalanobis, 0.5);
  EXPECT_EQ(all.candidates[1].mahalanobis, 1);
  EXPECT_EQ(all.candidates[2].mahalanobis, 0.2) << "the nearer of the two";
  EXPECT_EQ(all.counts.pairs, 100U);
  EXPECT_EQ(all.counts.kept, 3U);
  EXPECT_EQ(all.counts.distances_evaluated, 12U);
  EXPECT_EQ(all.alignments, 2U);
}

TEST(OverlapStage, AnAlignmentThatCouldNotBeSearchedAddsNothing) {
  OverlapStage all = stage({candidate(1, 1, 0.5)}, 7);
  add_candidates(all, {});
  EXPECT_EQ(all.candidates.size(), 1U);
  EXPECT_EQ(all.alignments, 1U);
}

}  // namespace
}  // namespace radioslam
