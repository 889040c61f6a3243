// Candidates of several team alignments.
#include "radioslam/joint/overlap_stage.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

CandidateResult candidate(double t_i_s, double t_j_s, float mahalanobis) {
  return {RobotIndex(0), Stamp::from_seconds(t_i_s), RobotIndex(1), Stamp::from_seconds(t_j_s), 5,
          mahalanobis};
}

OverlapStage stage(const std::vector<CandidateResult>& candidates, std::size_t evaluated) {
  const std::vector<Stamp> stamps{Stamp::from_seconds(1), Stamp::from_seconds(2)};
  OverlapStage result;
  result.candidates = CandidateList({stamps, stamps});
  for (const CandidateResult& c : candidates) result.candidates.push_back(c);
  result.counts.pairs = 100;
  result.counts.kept = result.candidates.size();
  result.counts.distances_evaluated = evaluated;
  result.searched = true;
  return result;
}

TEST(OverlapStage, CandidatesOfAlignmentsAreTheirUnion) {
  OverlapStage all = stage({candidate(1, 1, 0.5F), candidate(2, 1, 1.5F)}, 7);
  add_candidates(all, stage({candidate(1, 2, 1), candidate(2, 1, 0.2F)}, 5));
  std::vector<float> distances;
  for (const CandidateResult& c : all.candidates) distances.push_back(c.mahalanobis);
  EXPECT_EQ(distances, (std::vector<float>{0.5F, 1, 0.2F})) << "of two, the nearer one";
  EXPECT_EQ(all.counts.pairs, 100U);
  EXPECT_EQ(all.counts.kept, 3U);
  EXPECT_EQ(all.counts.distances_evaluated, 12U);
  EXPECT_EQ(all.alignments, 2U);
}

TEST(OverlapStage, AnAlignmentThatCouldNotBeSearchedAddsNothing) {
  OverlapStage all = stage({candidate(1, 1, 0.5F)}, 7);
  add_candidates(all, {});
  EXPECT_EQ(all.candidates.size(), 1U);
  EXPECT_EQ(all.alignments, 1U);
}

}  // namespace
}  // namespace radioslam
