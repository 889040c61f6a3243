#include "radioslam/rendezvous/anchored_exploration.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

using Role = AnchoredExploration::Role;

/// Two robots that hear each other.
struct Pair {
  AnchoredExploration a, b;
  double error_a = 0, error_b = 0, travelled_a = 0, travelled_b = 0;

  static AnchorNeighbour seen(const std::string& name, const AnchoredExploration& robot, double error,
                              double travelled) {
    return {name, robot.role() == Role::kStanding, robot.leans_on(), error, travelled, 10};
  }
  void decide() {
    const auto of_a = seen("a", a, error_a, travelled_a), of_b = seen("b", b, error_b, travelled_b);
    a.decide("a", error_a, travelled_a, {of_b}, {});
    b.decide("b", error_b, travelled_b, {of_a}, {});
    travelled_a += a.waits() ? 0 : 2;
    travelled_b += b.waits() ? 0 : 2;
  }
};

TEST(AnchoredExploration, OneOfTwoStandsWhileTheOtherExploresAndReturns) {
  Pair team;
  for (int k = 0; k < 5; ++k) team.decide();
  EXPECT_EQ(team.a.role(), Role::kStanding);
  EXPECT_EQ(team.b.role(), Role::kExploring);
  EXPECT_EQ(team.b.leans_on(), "a");
  team.error_b = 11;
  team.decide();
  EXPECT_EQ(team.b.role(), Role::kReturning);
}

TEST(AnchoredExploration, TheyTakeTurns) {
  Pair team;
  for (int k = 0; k < 5; ++k) team.decide();
  team.error_b = 0.1;
  team.b.met(team.travelled_b, {Pair::seen("a", team.a, 0, team.travelled_a)});
  EXPECT_EQ(team.b.role(), Role::kStanding);
  for (int k = 0; k < 5; ++k) team.decide();
  EXPECT_EQ(team.b.role(), Role::kStanding);
  EXPECT_EQ(team.a.role(), Role::kExploring);
  EXPECT_EQ(team.a.leans_on(), "b");
}

TEST(AnchoredExploration, NobodyStandsForOneThatDoesNotMoveAnyMore) {
  Pair team;
  for (int k = 0; k < 5; ++k) team.decide();
  const double travelled = team.travelled_b;
  for (int k = 0; k < 40; ++k) {
    team.decide();
    team.travelled_b = travelled;  // b is stuck, or has stopped
  }
  EXPECT_EQ(team.a.role(), Role::kExploring);
}

TEST(AnchoredExploration, ALoneRobotExplores) {
  AnchoredExploration robot;
  for (int k = 0; k < 5; ++k) {
    robot.decide("a", 50, 2.0 * k, {}, {});
    EXPECT_EQ(robot.role(), Role::kExploring);
    EXPECT_FALSE(robot.waits());
  }
}

}  // namespace
}  // namespace radioslam
