#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "radioslam/base/random.hpp"
#include "radioslam/results/candidate_list.hpp"

namespace radioslam {
namespace {

constexpr std::uint32_t kKeyframes = 40;
constexpr std::size_t kRobots = 4;

using Group = CandidateList::Group;
/// By probability, then robots and keyframes.
using Plain = std::tuple<float, float, std::size_t, std::size_t, std::uint32_t, std::uint32_t>;

std::vector<Plain> plain(const std::vector<Group>& groups) {
  std::vector<Plain> rows;
  for (const Group& group : groups)
    for (const CandidateList::Row& row : group.rows)
      rows.emplace_back(row.mahalanobis, row.distance_m, group.robot_i.index(), group.robot_j.index(),
                        row.keyframe_i, row.keyframe_j);
  return rows;
}

CandidateList list_of_team() {
  std::vector<Stamp> stamps;
  for (std::uint32_t k = 0; k < kKeyframes; ++k) stamps.push_back(Stamp::from_seconds(k));
  return CandidateList(std::vector<std::vector<Stamp>>(kRobots, stamps));
}

/// All pairs, many of them within reach, many equally far.
std::vector<Group> groups_of_team(Rng& rng) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < kRobots; ++i)
    for (std::size_t j = i + 1; j < kRobots; ++j) {
      Group& group = groups.emplace_back(Group{RobotIndex(i), RobotIndex(j), {}});
      for (std::uint32_t k = 0; k < kKeyframes; ++k)
        for (std::uint32_t l = 0; l < kKeyframes; ++l)
          group.rows.push_back({k, l, static_cast<float>(rng.below(30)),
                                std::max(0.0F, static_cast<float>(rng.below(40)) / 10 - 2)});
    }
  return groups;
}

std::vector<Group> most_probable(const std::vector<Group>& groups, std::size_t limit) {
  MostProbableCandidates selection(limit);
  for (const Group& group : groups) selection.add(group);
  CandidateList list = list_of_team();
  selection.move_to(list);
  return list.groups();
}

TEST(MostProbableCandidates, AreTheFirstOfAllInOrderOfProbability) {
  Rng rng(1);
  const auto groups = groups_of_team(rng);
  auto expected = plain(groups);
  std::sort(expected.begin(), expected.end());
  for (const std::size_t limit : {1U, 7U, 500U, 5000U, 9599U, 9600U, 20000U}) {
    auto kept = plain(most_probable(groups, limit));
    std::sort(kept.begin(), kept.end());
    const auto count = std::min(limit, expected.size());
    EXPECT_EQ(kept, (std::vector<Plain>(expected.begin(), expected.begin() + static_cast<int>(count))))
        << limit;
  }
  EXPECT_TRUE(most_probable(groups, 0).empty());
}

TEST(MostProbableCandidates, AreListedByRobotsAndKeyframesInWhateverOrderTheyCame) {
  Rng rng(2);
  auto groups = groups_of_team(rng);
  const auto kept = most_probable(groups, 700);
  const auto by_place = [](const Plain& a, const Plain& b) {
    return std::tuple(std::get<2>(a), std::get<3>(a), std::get<4>(a), std::get<5>(a)) <
           std::tuple(std::get<2>(b), std::get<3>(b), std::get<4>(b), std::get<5>(b));
  };
  const auto rows = plain(kept);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(), by_place));
  std::reverse(groups.begin(), groups.end());
  EXPECT_EQ(plain(most_probable(groups, 700)), rows);
}

TEST(MostProbableCandidates, WithoutAnyToDropAreAll) {
  Rng rng(3);
  const auto groups = groups_of_team(rng);
  EXPECT_EQ(plain(most_probable(groups, 1U << 20U)), plain(groups));
}

}  // namespace
}  // namespace radioslam
