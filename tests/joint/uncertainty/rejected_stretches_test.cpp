// Where the evidence of a robot was mostly rejected.
#include "radioslam/joint/uncertainty/rejected_stretches.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

using Stretches = std::vector<std::pair<Stamp, Stamp>>;

Stamp at(double t_s) { return Stamp::from_seconds(t_s); }

/// A closure per second between the robot and another one, rejected from `begin_s` to
/// `end_s` and every fifth one elsewhere.
std::vector<ClosureResult> closures(std::size_t robot, int seconds, int begin_s, int end_s,
                                    ClosureKind kind = ClosureKind::kFingerprint) {
  std::vector<ClosureResult> result;
  for (int t = 0; t < seconds; ++t) {
    ClosureResult& closure = result.emplace_back();
    closure.robot_i = RobotIndex(robot);
    closure.stamp_i = at(t);
    closure.robot_j = RobotIndex(9);
    closure.stamp_j = at(t);
    closure.kind = kind;
    const bool is_rejected = (t >= begin_s && t < end_s) || t % 5 == 0;
    closure.status = is_rejected ? ClosureStatus::kRejected : ClosureStatus::kAccepted;
  }
  return result;
}

TEST(RejectedStretches, AreWhereMostWasRejected) {
  const auto found = rejected_stretches(2, closures(1, 600, 301, 370));
  EXPECT_TRUE(found[0].empty());
  EXPECT_EQ(found[1], (Stretches{{at(300), at(370)}}));
}

TEST(RejectedStretches, SoundRobotsHaveNone) {
  EXPECT_EQ(rejected_stretches(1, closures(0, 600, 0, 0))[0], Stretches{});
  EXPECT_EQ(rejected_stretches(1, closures(0, 600, 300, 328))[0], Stretches{}) << "too short";
  EXPECT_EQ(rejected_stretches(1, {})[0], Stretches{});
}

TEST(RejectedStretches, SeveralAreInTimeOrder) {
  auto all = closures(0, 900, 100, 161);
  for (const auto& closure : closures(0, 900, 601, 661))
    if (closure.stamp_i > at(450)) all[static_cast<std::size_t>(closure.stamp_i.seconds())] = closure;
  EXPECT_EQ(rejected_stretches(1, all)[0], (Stretches{{at(100), at(160)}, {at(600), at(660)}}));
}

TEST(RejectedStretches, KindsThatAreMostlyRejectedSayNothing) {
  auto all = closures(0, 600, 0, 600, ClosureKind::kMatch);
  EXPECT_EQ(rejected_stretches(1, all)[0], Stretches{});
}

}  // namespace
}  // namespace radioslam
