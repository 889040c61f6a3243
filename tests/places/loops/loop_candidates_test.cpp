#include "radioslam/places/loops/loop_candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "lidar/scanned_room.hpp"

namespace radioslam {
namespace {

using namespace test;

/// Out along x and back, a keyframe per metre, with a view of 10 m.
ScanKeyframes there_and_back(int way_m) {
  ScanKeyframes keyframes;
  for (int k = 0; k <= 2 * way_m; ++k) {
    keyframes.poses.push_back(pose_at(k <= way_m ? k : 2 * way_m - k, 0, 0, 0));
    ScanPyramid cloud;
    cloud.all.push_back({Eigen::Vector3f::Zero(), Eigen::Matrix3f::Identity()});
    cloud.median_range_m = 10;
    keyframes.clouds.push_back(CloudStore().add(cloud));
    if (k > 0) keyframes.step_covariances.push_back(isotropic(0.04, 1e-8));
  }
  return keyframes;
}

/// With steps as uncertain as `scale` times what the keyframes say.
PoseGraph<SE3> graph_of(const ScanKeyframes& keyframes, double scale) {
  PoseGraph<SE3> graph;
  graph.poses = keyframes.poses;
  for (std::size_t k = 0; k + 1 < keyframes.poses.size(); ++k) {
    RelativePoseFactor<SE3> step;
    step.i = PoseId(k);
    step.j = PoseId(k + 1);
    step.T_i_j = keyframes.poses[k].inverse() * keyframes.poses[k + 1];
    step.information = (scale * scale * keyframes.step_covariances[k]).inverse();
    graph.relative_poses.push_back(step);
  }
  return graph;
}

ScanLoop outcome(const LoopCandidate& candidate, LoopStatus status) {
  ScanLoop loop;
  loop.i = candidate.i;
  loop.j = candidate.j;
  loop.status = status;
  return loop;
}

std::size_t count_after(LoopStatus status, double scale) {
  const ScanKeyframes keyframes = there_and_back(15);
  LoopCandidates candidates(keyframes, {});
  const auto found = candidates.find(graph_of(keyframes, 1));
  EXPECT_GT(found.size(), 3U);
  for (const LoopCandidate& candidate : found) {
    EXPECT_GE(candidates.path_m()[candidate.j] - candidates.path_m()[candidate.i], 10);
    EXPECT_LE(
        (keyframes.poses[candidate.i].translation() - keyframes.poses[candidate.j].translation()).norm(), 6);
    candidates.note(outcome(candidate, status));
  }
  const auto again = candidates.find(graph_of(keyframes, scale));
  return static_cast<std::size_t>(std::count_if(again.begin(), again.end(), [&](const LoopCandidate& pair) {
    return std::any_of(found.begin(), found.end(),
                       [&](const LoopCandidate& before) { return before.i == pair.i && before.j == pair.j; });
  }));
}

TEST(LoopCandidates, ThatWereDoubtfulAreTriedAgainOncePredictedTwiceAsWell) {
  for (const LoopStatus doubtful :
       {LoopStatus::kAmbiguous, LoopStatus::kUnmapped, LoopStatus::kAnotherStorey}) {
    EXPECT_EQ(count_after(doubtful, 1), 0U);
    EXPECT_EQ(count_after(doubtful, 0.55), 0U);
    EXPECT_GT(count_after(doubtful, 0.45), 3U);
  }
}

TEST(LoopCandidates, ThatWereDecidedAreNotTriedAgain) {
  for (const LoopStatus decided :
       {LoopStatus::kAccepted, LoopStatus::kLowOverlap, LoopStatus::kTooLittleStructure})
    EXPECT_EQ(count_after(decided, 0.45), 0U);
}

TEST(LoopCandidates, ThatAreLeftOutComeAgainTheWorthiestFirst) {
  const ScanKeyframes keyframes = there_and_back(15);
  const PoseGraph<SE3> graph = graph_of(keyframes, 1);
  LoopCandidates candidates(keyframes, {});
  const auto all = candidates.find(graph);
  auto found = all;
  EXPECT_FALSE(candidates.leave_out(all.size(), graph, found));
  ASSERT_EQ(found.size(), all.size());
  EXPECT_TRUE(candidates.leave_out(1, graph, found));
  ASSERT_EQ(found.size(), 1U);
  const auto path_m = [&](const LoopCandidate& of) {
    return candidates.path_m()[of.j] - candidates.path_m()[of.i];
  };
  for (const LoopCandidate& other : all) EXPECT_LE(path_m(other), path_m(found[0]) + 4);
  candidates.note(outcome(found[0], LoopStatus::kAccepted));
  auto again = candidates.find(graph);
  EXPECT_EQ(again.size(), all.size() - 1);
  EXPECT_TRUE(candidates.leave_out(0, graph, again));
  EXPECT_TRUE(again.empty());
}

}  // namespace
}  // namespace radioslam
