#include "radioslam/results/candidate_list.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }
RobotIndex robot(int index) { return RobotIndex(index); }

using Plain = std::tuple<int, std::int64_t, int, std::int64_t, float, float>;
std::vector<Plain> plain(const CandidateList& list) {
  std::vector<Plain> rows;
  for (const CandidateResult& c : list)
    rows.emplace_back(c.robot_i.value, c.stamp_i.ns, c.robot_j.value, c.stamp_j.ns, c.distance_m,
                      c.mahalanobis);
  return rows;
}
Plain plain(const CandidateResult& c) {
  return {c.robot_i.value, c.stamp_i.ns, c.robot_j.value, c.stamp_j.ns, c.distance_m, c.mahalanobis};
}

TEST(CandidateList, GivesBackWhatWasAppended) {
  Rng rng(1);
  CandidateList list;
  std::vector<Plain> expected;
  for (int k = 0; k < 500; ++k) {
    const CandidateResult candidate{robot(0),
                                    at(static_cast<double>(rng.below(40))),
                                    robot(3),
                                    at(0.5 * static_cast<double>(rng.below(70))),
                                    static_cast<float>(rng.uniform()),
                                    static_cast<float>(rng.uniform())};
    list.push_back(candidate);
    expected.push_back(plain(candidate));
  }
  EXPECT_EQ(list.size(), 500U);
  EXPECT_EQ(plain(list), expected);
  list.push_back({robot(3), at(1), robot(1), at(2), 3, 4});
  list.push_back({robot(0), at(99), robot(3), at(2), 3, 4});
  EXPECT_EQ(list.groups().size(), 2U) << "one group for two robots in one order";
  EXPECT_EQ(list.size(), 502U);
}

TEST(CandidateList, EmptyGroupsAreSkipped) {
  CandidateList list(std::vector<std::vector<Stamp>>{{at(1)}, {at(2)}, {at(3)}});
  EXPECT_TRUE(list.empty());
  EXPECT_TRUE(list.begin() == list.end());
  EXPECT_TRUE(list.stamps(robot(7)).empty());
  list.append({robot(0), robot(1), {}});
  list.append({robot(0), robot(2), {{0, 0, 5, 1}}});
  EXPECT_EQ(plain(list), (std::vector<Plain>{{0, at(1).ns, 2, at(3).ns, 5, 1}}));
}

TEST(CandidateList, ContainsAPairInEitherOrder) {
  CandidateList list(std::vector<std::vector<Stamp>>{{at(1), at(2), at(4)}, {at(1), at(3)}});
  list.append({robot(0), robot(1), {{0, 1, 5, 1}, {2, 0, 6, 1}}});
  EXPECT_TRUE(list.contains(robot(0), at(1), robot(1), at(3)));
  EXPECT_TRUE(list.contains(robot(1), at(1), robot(0), at(4)));
  EXPECT_FALSE(list.contains(robot(0), at(1), robot(1), at(1)));
  EXPECT_FALSE(list.contains(robot(1), at(3), robot(0), at(2)));
  EXPECT_FALSE(list.contains(robot(0), at(7), robot(1), at(3))) << "no such keyframe";
}

TEST(CandidateList, MergesSortedGroups) {
  CandidateList list(std::vector<std::vector<Stamp>>{{at(1), at(2)}, {at(1), at(2)}});
  CandidateList::Group group{robot(0), robot(1), {{0, 0, 5, 1}, {1, 0, 6, 2}}};
  merge(group, {robot(0), robot(1), {{0, 1, 7, 1.5F}, {1, 0, 4, 0.5F}}});
  list.append(group);
  EXPECT_EQ(plain(list), (std::vector<Plain>{{0, at(1).ns, 1, at(1).ns, 5, 1},
                                             {0, at(1).ns, 1, at(2).ns, 7, 1.5F},
                                             {0, at(2).ns, 1, at(1).ns, 4, 0.5F}}))
      << "of a pair in both, the nearer one";
}

TEST(CandidateList, RobotsCanBeRenumbered) {
  CandidateList list(std::vector<std::vector<Stamp>>{{at(1)}, {at(2)}});
  list.append({robot(0), robot(1), {{0, 0, 5, 1}}});
  list.renumber_robots({robot(4), robot(2)});
  EXPECT_EQ(plain(list), (std::vector<Plain>{{4, at(1).ns, 2, at(2).ns, 5, 1}}));
  EXPECT_TRUE(list.contains(robot(2), at(2), robot(4), at(1)));
}

}  // namespace
}  // namespace radioslam
