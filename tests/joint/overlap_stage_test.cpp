// What the overlap search hands over, lists and answers, of one alignment and of several.
#include "radioslam/joint/overlap_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "pipeline/town_runs.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kAll = 1U << 30U;

/// Robots and keyframes.
using Place = std::tuple<std::size_t, std::size_t, std::uint32_t, std::uint32_t>;

std::map<Place, CandidateList::Row> rows_of(const CandidateList& list) {
  std::map<Place, CandidateList::Row> rows;
  for (const auto& group : list.groups())
    for (const auto& row : group.rows)
      rows[{group.robot_i.index(), group.robot_j.index(), row.keyframe_i, row.keyframe_j}] = row;
  return rows;
}

/// Probability first.
std::vector<std::tuple<float, float, Place>> by_probability(const CandidateList& list) {
  std::vector<std::tuple<float, float, Place>> sorted;
  for (const auto& [place, row] : rows_of(list)) sorted.emplace_back(row.mahalanobis, row.distance_m, place);
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// Three robots with dead reckoning from known starts.
class OverlapOfATown : public testing::Test {
 protected:
  OverlapOfATown() {
    CityParams city = test::small_city(600);
    city.robots = 3;
    auto [mission, truth] = simulate_city(city, 5);
    for (std::size_t r = 0; r < mission.robots.size(); ++r)
      mission.robots[r].initial_pose = truth.robots[r].poses.front().pose;
    joint = build_joint_graph<SE2>(mission, {}, {});
    all = find_overlaps<SE2>({joint}, {}, {SearchMethod::kTree, kAll, {}, nullptr});
  }

  JointGraph<SE2> joint;
  OverlapStage all;
};

TEST_F(OverlapOfATown, ListsTheMostProbableAndHandsOverAll) {
  ASSERT_TRUE(all.searched);
  ASSERT_GT(all.listed.size(), 300U);
  EXPECT_EQ(all.counts.kept, all.listed.size());
  CandidateList taken = all.of_asked;
  const auto few = find_overlaps<SE2>(
      {joint}, {},
      {SearchMethod::kTree, 100, {}, [&](const CandidateList::Group& group, const CandidateList& keyframes) {
         EXPECT_EQ(keyframes.stamps(group.robot_j), all.listed.stamps(group.robot_j));
         taken.append(group);
       }});
  auto expected = by_probability(all.listed);
  EXPECT_EQ(by_probability(taken), expected);
  expected.resize(100);
  EXPECT_EQ(by_probability(few.listed), expected);
  EXPECT_EQ(few.counts.kept, all.counts.kept);
  EXPECT_EQ(few.counts.pairs, all.counts.pairs);
}

TEST_F(OverlapOfATown, KnowsThePairsThatWereAskedForWithoutListingThem) {
  std::vector<KeyframePair> asked;
  const auto ask = [&](std::size_t i, std::size_t j) {
    for (std::size_t k = 0; k < joint.robots[i].stamps.size(); k += 3)
      for (std::size_t l = 0; l < joint.robots[j].stamps.size(); l += 4)
        asked.push_back({RobotIndex(i), joint.robots[i].stamps[k], RobotIndex(j), joint.robots[j].stamps[l]});
  };
  ask(0, 1), ask(2, 1);
  const auto stage = find_overlaps<SE2>({joint}, {}, {SearchMethod::kTree, 0, asked, nullptr});
  EXPECT_TRUE(stage.listed.empty());
  EXPECT_EQ(stage.counts.kept, all.counts.kept);
  std::size_t found = 0;
  for (const KeyframePair& pair : asked) {
    const bool expected = all.listed.contains(pair.robot_i, pair.stamp_i, pair.robot_j, pair.stamp_j);
    EXPECT_EQ(stage.of_asked.contains(pair.robot_i, pair.stamp_i, pair.robot_j, pair.stamp_j), expected);
    found += expected ? 1U : 0U;
  }
  EXPECT_GT(found, 10U);
  EXPECT_EQ(stage.of_asked.size(), found) << "and nothing else";
}

TEST_F(OverlapOfATown, OfSeveralAlignmentsIsTheUnion) {
  JointGraph<SE2> other = joint;
  for (const PoseId pose : joint.robots[1].poses)
    other.team.graph.poses[pose.index()] = SE2({25, 10}, 0) * other.team.graph.poses[pose.index()];
  const auto of_other = find_overlaps<SE2>({other}, {}, {SearchMethod::kTree, kAll, {}, nullptr});
  ASSERT_NE(by_probability(of_other.listed), by_probability(all.listed)) << "or the test shows nothing";
  auto expected = rows_of(all.listed);
  for (const auto& [place, row] : rows_of(of_other.listed)) {
    const auto [known, is_new] = expected.emplace(place, row);
    if (!is_new && row.mahalanobis < known->second.mahalanobis) known->second = row;
  }
  const auto both = find_overlaps<SE2>({joint, other}, {}, {SearchMethod::kTree, kAll, {}, nullptr});
  const auto rows = rows_of(both.listed);
  ASSERT_EQ(rows.size(), expected.size());
  for (const auto& [place, row] : rows) {
    ASSERT_TRUE(expected.count(place));
    EXPECT_EQ(row.mahalanobis, expected[place].mahalanobis) << "of two, the nearer one";
  }
  EXPECT_EQ(both.counts.kept, expected.size());
  EXPECT_EQ(both.counts.pairs, all.counts.pairs);
  EXPECT_EQ(both.counts.distances_evaluated,
            all.counts.distances_evaluated + of_other.counts.distances_evaluated);
  EXPECT_EQ(both.alignments, 2U);
}

TEST_F(OverlapOfATown, AnAlignmentThatCannotBeSearchedAddsNothing) {
  JointGraph<SE2> loose = joint;
  for (auto& step : loose.team.graph.relative_poses) step.weight = 0;
  const auto stage = find_overlaps<SE2>({joint, loose}, {}, {SearchMethod::kTree, kAll, {}, nullptr});
  EXPECT_EQ(by_probability(stage.listed), by_probability(all.listed));
  EXPECT_EQ(stage.alignments, 1U);
  EXPECT_FALSE(find_overlaps<SE2>({loose, joint}, {}, {SearchMethod::kTree, kAll, {}, nullptr}).searched);
}

}  // namespace
}  // namespace radioslam
