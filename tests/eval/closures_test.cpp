#include "radioslam/eval/closures.hpp"

#include <gtest/gtest.h>

#include "eval/teams.hpp"

namespace radioslam {
namespace {

KeyframeStamps stamps_of(const Trajectory<SE3>& path) {
  KeyframeStamps stamps;
  for (const auto& [stamp, pose] : path) stamps.push_back(stamp);
  return stamps;
}

RobotIndex robot(int i) { return RobotIndex(i); }

/// Robot a moves along x, robot b is at rest at x = 2 m; one pose per second and metre.
Truth walker_and_post() {
  std::vector<StampedPose<SE3>> walker, post;
  for (int i = 0; i < 10; ++i) {
    walker.push_back({Stamp::from_seconds(i), lift(SE2({double(i), 0}, 0), 100)});
    post.push_back({Stamp::from_seconds(i), lift(SE2({2, 0}, 0))});
  }
  return {{{"a", Trajectory<SE3>(walker)}, {"b", Trajectory<SE3>(post)}}};
}

TEST(CountCandidates, ByHand) {
  const Truth truth = walker_and_post();
  const std::vector<KeyframeStamps> keyframes{stamps_of(truth.robots[0].poses), {Stamp::from_seconds(0.5)}};
  CandidateList kept;
  for (const CandidateResult& candidate : {CandidateResult{robot(0), Stamp::from_seconds(1.5), robot(1),
                                                           Stamp::from_seconds(0.5), 0, 0},  // 0.5 m: true
                                           CandidateResult{robot(1), Stamp::from_seconds(0.5), robot(0),
                                                           Stamp::from_seconds(4), 0, 0},  // 2 m: not closer
                                           CandidateResult{robot(0), Stamp::from_seconds(99), robot(1),
                                                           Stamp::from_seconds(0.5), 0, 0}})  // no truth
    kept.push_back(candidate);
  const auto counts = count_candidates(keyframes, kept, {truth, 2, reach_for_radius(2, 2)});
  EXPECT_EQ(counts.pairs, 10U);
  EXPECT_EQ(counts.true_pairs, 3U);  // x = 1, 2, 3
  EXPECT_EQ(counts.kept, 2U);
  EXPECT_EQ(counts.true_kept, 1U);
}

TEST(CountCandidates, HeightCountsInSpaceOnly) {
  const Truth truth = walker_and_post();
  const std::vector<KeyframeStamps> keyframes{stamps_of(truth.robots[0].poses), {Stamp{}}};
  EXPECT_EQ(count_candidates(keyframes, {}, {truth, 3, reach_for_radius(2, 2)}).true_pairs, 0U);
  EXPECT_EQ(count_candidates(keyframes, {}, {truth, 3, {70, 30.02}}).true_pairs, 5U);  // a reach of 100.02 m
}

TEST(CountCandidates, EqualsTheCountOverAllPairs) {
  const Truth truth = test::winding_team(1, 4, 60);
  std::vector<KeyframeStamps> keyframes;
  for (const auto& path : truth.robots) keyframes.push_back(stamps_of(path.poses));
  const std::vector<double> reach{1, 2, 4, 8};
  std::size_t close = 0, pairs = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (const auto& a : truth.robots[i].poses)
        for (const auto& b : truth.robots[j].poses) {
          ++pairs;
          if ((a.pose.translation() - b.pose.translation()).norm() < reach[i] + reach[j]) ++close;
        }
  const auto counts = count_candidates(keyframes, {}, {truth, 3, reach});
  EXPECT_EQ(counts.pairs, pairs);
  EXPECT_EQ(counts.true_pairs, close);
  EXPECT_GT(close, 0U);
}

TEST(CountCandidates, KeyframesWithoutTruthAreNotCounted) {
  const Truth truth = walker_and_post();
  const std::vector<KeyframeStamps> keyframes{{Stamp::from_seconds(2), Stamp::from_seconds(9.4)},
                                              {Stamp::from_seconds(3)}};
  EXPECT_EQ(count_candidates(keyframes, {}, {truth, 2, reach_for_radius(2, 2)}).pairs, 1U);
  Truth waypoints = truth;
  waypoints.robots[0].has_orientation = false;  // stamped by hand: the last one is valid for half a second
  EXPECT_EQ(count_candidates(keyframes, {}, {waypoints, 2, reach_for_radius(2, 2)}).pairs, 2U);
}

TEST(CountClosures, TheAcceptedOnesAreKept) {
  const Truth truth = walker_and_post();
  const auto closure = [](int i, double t_i_s, ClosureStatus status) {
    ClosureResult result;
    result.robot_i = robot(i);
    result.stamp_i = Stamp::from_seconds(t_i_s);
    result.robot_j = robot(1);
    result.stamp_j = Stamp::from_seconds(3);
    result.status = status;
    return result;
  };
  const auto counts = count_closures(
      {closure(0, 2, ClosureStatus::kAccepted), closure(0, 3, ClosureStatus::kRejected),
       closure(0, 8, ClosureStatus::kAccepted), closure(1, 8, ClosureStatus::kAccepted),  // within one robot
       closure(0, 80, ClosureStatus::kAccepted)},                                         // no truth
      {truth, 2, reach_for_radius(2, 5)});
  EXPECT_EQ(counts.pairs, 3U);
  EXPECT_EQ(counts.true_pairs, 2U);
  EXPECT_EQ(counts.kept, 2U);
  EXPECT_EQ(counts.true_kept, 1U);
}

TEST(CountClosuresDeathTest, EveryRobotNeedsAReach) {
  const Truth truth = walker_and_post();
  EXPECT_DEATH(count_closures({}, {truth, 2, {1}}), "one reach");
}

}  // namespace
}  // namespace radioslam
