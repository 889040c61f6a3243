#include "radioslam/eval/closures.hpp"

#include <gtest/gtest.h>

#include <numbers>

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
  EXPECT_EQ(count_candidates(keyframes, {}, {truth, 3, {{70}, {30.02}}}).true_pairs,
            5U);  // a reach of 100.02 m
}

TEST(CountCandidates, EqualsTheCountOverAllPairs) {
  const Truth truth = test::winding_team(1, 4, 60);
  std::vector<KeyframeStamps> keyframes;
  for (const auto& path : truth.robots) keyframes.push_back(stamps_of(path.poses));
  const std::vector<OverlapSensor> views{{1}, {2}, {4}, {8}};
  std::size_t close = 0, pairs = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (const auto& a : truth.robots[i].poses)
        for (const auto& b : truth.robots[j].poses) {
          ++pairs;
          if ((a.pose.translation() - b.pose.translation()).norm() < views[i].range_m + views[j].range_m)
            ++close;
        }
  const auto counts = count_candidates(keyframes, {}, {truth, 3, views});
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

/// True pairs of the walker at x = 0 to 9 m and the post at 2 m.
std::size_t true_pairs(const Truth& truth, const std::vector<OverlapSensor>& views, double min_shared_view) {
  const std::vector<KeyframeStamps> keyframes{stamps_of(truth.robots[0].poses), {Stamp{}}};
  return count_candidates(keyframes, {}, {truth, 2, views, min_shared_view}).true_pairs;
}

TEST(CountCandidates, TruePairsShareEnoughOfTheirViews) {
  const Truth truth = walker_and_post();
  EXPECT_EQ(true_pairs(truth, {{2}, {2}}, 0), 6U) << "closer than 4 m";
  EXPECT_EQ(true_pairs(truth, {{2}, {2}}, 0.18), 5U) << "two discs of 2 m share 0.18 at 2.3 m";
  EXPECT_EQ(true_pairs(truth, {{5}, {2}}, 0.18), 0U) << "a disc in one of six times its area";
  EXPECT_EQ(true_pairs(truth, reach_for_radius(2, 2.3), 0), 5U);
}

TEST(CountCandidates, HeadingsOfLimitedViewsCountWhereTheyMustShare) {
  Truth truth = walker_and_post();
  const std::vector<OverlapSensor> half_discs(2, {3, std::numbers::pi});
  EXPECT_EQ(true_pairs(truth, half_discs, 0), 8U) << "closer than 6 m, whatever the headings";
  EXPECT_EQ(true_pairs(truth, half_discs, 0.18), 3U) << "both look east: 0.41 at 1 m, 0.12 at 2 m";
  truth.robots[1].poses = test::changed(truth.robots[1].poses, [](const SE3& pose) {
    return SE3(pose.translation(), lift(SE2({0, 0}, std::numbers::pi)).rotation());
  });
  EXPECT_EQ(true_pairs(truth, half_discs, 0.18), 2U) << "face to face at 0 and 1 m: 0.57, 0.26";
  for (RobotTruth& robot : truth.robots) robot.has_orientation = false;
  EXPECT_EQ(true_pairs(truth, half_discs, 0.18), 6U) << "unknown headings: discs, 3.5 m";
}

TEST(CountCandidates, OfExactKeyframesTheCandidatesThatShareEnoughAreTrue) {
  const Truth truth = walker_and_post();
  CandidateList kept;
  for (const double t_s : {0.0, 3.0, 4.9})
    kept.push_back({robot(1), Stamp{}, robot(0), Stamp::from_seconds(t_s), 0, 0});
  const std::vector<KeyframeStamps> keyframes{stamps_of(truth.robots[0].poses), {Stamp{}}};
  const auto counts = count_candidates(keyframes, kept, {truth, 2, {{2}, {2}}, 0.18});
  EXPECT_EQ(counts.kept, 3U);
  EXPECT_EQ(counts.true_kept, 2U) << "2 and 1 m apart, not 2.9";
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

TEST(CountClosuresDeathTest, EveryRobotNeedsAView) {
  const Truth truth = walker_and_post();
  EXPECT_DEATH(count_closures({}, {truth, 2, {{1}}}), "one view");
}

}  // namespace
}  // namespace radioslam
