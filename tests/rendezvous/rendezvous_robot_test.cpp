#include "radioslam/rendezvous/rendezvous_robot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

namespace radioslam {
namespace {

/// Robots on an open floor without noise, at places that a test sets; all hear each other as well as it says.
class Floor {
 public:
  explicit Floor(RendezvousParams params = {}) : params_(params) {}

  void add(const std::string& name, const SE2& truth) {
    RobotStart start;
    start.pose = truth;
    robots_[name] = {std::make_unique<RendezvousRobot>(name, start, params_), truth, truth.inverse()};
  }
  void remove(const std::string& name) { robots_.erase(name); }
  RendezvousRobot& robot(const std::string& name) { return *robots_.at(name).agent; }
  const SE2& truth(const std::string& name) { return robots_.at(name).truth; }
  const Movement& movement(const std::string& name) { return robots_.at(name).movement; }
  /// The next packets to a robot do not arrive.
  void deafen(const std::string& name, int iterations) { deaf_[name] = iterations; }

  void move(const std::string& name, double ahead_m, double sigma_m = 0.2, double sigma_rad = 0.09) {
    Robot& robot = robots_.at(name);
    robot.truth = robot.truth * SE2({ahead_m, 0}, 0);
    robot.agent->move({time_s_, SE2({ahead_m, 0}, 0), sigma_m, sigma_rad});
  }

  void step() {
    time_s_ += 1;
    for (auto& [name, robot] : robots_)
      if (name != held_) follow(robot);
    for (auto& [name, robot] : robots_)
      for (const auto& [other_name, other] : robots_)
        if (name != other_name && distance(robot, other) < 2.2)
          robot.agent->see({time_s_, other_name, robot.truth.inverse() * other.truth, 0.2, 0.09});
    exchange(false);
    for (int round = 0; round < 4; ++round) exchange(true);
    for (auto& [name, count] : deaf_) --count;
  }

  double time_s() const { return time_s_; }
  /// The robot decides, but does not move.
  void hold(const std::string& name) { held_ = name; }

 private:
  struct Robot {
    std::unique_ptr<RendezvousRobot> agent;
    SE2 truth, T_raw_common;  ///< of the start as origin
    Movement movement{Movement::Kind::kStay};
    std::vector<OutgoingMessage> outbox{};
  };

  static double distance(const Robot& a, const Robot& b) {
    return (a.truth.translation() - b.truth.translation()).norm();
  }

  void follow(Robot& robot) {
    if (robot.movement.kind != Movement::Kind::kMove) return;
    const Eigen::Vector2d offset = (robot.T_raw_common * robot.truth).inverse() * robot.movement.target;
    const SE2 step(offset, std::atan2(offset.y(), offset.x()));
    robot.truth = robot.truth * step;
    robot.agent->move({time_s_, step, 0.2, 0.09});
  }

  void exchange(bool talk) {
    for (auto& [name, robot] : robots_) {
      if (deaf_[name] > 0) continue;
      for (const auto& [other_name, other] : robots_) {
        if (name == other_name) continue;
        const Eigen::Vector2d offset = robot.truth.inverse() * other.truth.translation();
        HeardPacket packet{time_s_,
                           other_name,
                           55 - 22 * std::log10(std::max(0.3, offset.norm())),
                           {{std::atan2(offset.y(), offset.x()), 0.15, 0}},
                           {}};
        robot.agent->hear(packet);
        for (const OutgoingMessage& message : other.outbox) {
          if (!message.to.empty() && message.to != name) continue;
          if (message.reach == Reach::kData && packet.esnr_db < params_.q_db) continue;
          packet.message = message.message;
          robot.agent->hear(packet);
        }
      }
    }
    for (auto& [name, robot] : robots_) {
      TickAnswer answer = robot.agent->tick({time_s_, talk});
      robot.outbox = std::move(answer.messages);
      if (answer.movement) robot.movement = *answer.movement;
    }
  }

  RendezvousParams params_;
  std::map<std::string, Robot> robots_;
  std::map<std::string, int> deaf_;
  std::string held_;
  double time_s_ = 0;
};

/// One that has gone so far that it calls, and another that has not moved.
Floor lost_robot(double distance_m) {
  Floor floor;
  floor.add("a", SE2());
  floor.add("b", SE2({0, distance_m}, 0));
  for (int k = 0; k < 16; ++k) floor.move("a", 2);
  return floor;
}

TEST(RendezvousRobot, CallsAnotherWhichWalksUpUntilTheyHaveSeenEachOther) {
  Floor floor = lost_robot(10);
  const double lost = floor.robot("a").state().error;
  EXPECT_GT(lost, floor.robot("a").delta());
  const SE2 stands = floor.truth("a");
  for (int k = 0; k < 60 && floor.robot("a").rendezvous_held() == 0; ++k) floor.step();
  EXPECT_EQ(floor.robot("a").rendezvous_held(), 1);
  EXPECT_LT(floor.robot("a").state().error, 1);
  EXPECT_EQ((floor.truth("a").translation() - stands.translation()).norm(), 0);
  for (int k = 0; k < 3; ++k) floor.step();
  EXPECT_FALSE(floor.robot("a").state().asking);
  EXPECT_EQ(floor.robot("b").state().serving, "");
  EXPECT_EQ(floor.movement("b").kind, Movement::Kind::kExplore);
  EXPECT_EQ(floor.robot("a").state().team, (std::vector<std::string>{"a", "b"}));
}

TEST(RendezvousRobot, NobodyWaitsForOneThatVanishesLongerThanStated) {
  Floor floor = lost_robot(40);
  for (int k = 0; k < 8; ++k) floor.step();
  ASSERT_EQ(floor.robot("b").state().serving, "a");
  ASSERT_EQ(floor.movement("a").kind, Movement::Kind::kStay);
  floor.remove("b");
  const double vanished_s = floor.time_s();
  while (floor.movement("a").kind == Movement::Kind::kStay && floor.time_s() < vanished_s + 100) floor.step();
  EXPECT_LE(floor.time_s() - vanished_s, RendezvousParams{}.lost_after_s + 2);
}

TEST(RendezvousRobot, AWalkerGivesUpOnACallerThatVanishes) {
  Floor floor = lost_robot(40);
  for (int k = 0; k < 8; ++k) floor.step();
  ASSERT_EQ(floor.robot("b").state().serving, "a");
  floor.remove("a");
  for (int k = 0; k < 23; ++k) floor.step();
  EXPECT_EQ(floor.robot("b").state().serving, "");
  EXPECT_EQ(floor.movement("b").kind, Movement::Kind::kExplore);
}

TEST(RendezvousRobot, AShortSilenceDoesNoHarm) {
  Floor floor = lost_robot(30);
  for (int k = 0; k < 5; ++k) floor.step();
  floor.deafen("a", 4);
  floor.deafen("b", 3);
  for (int k = 0; k < 80 && floor.robot("a").rendezvous_held() == 0; ++k) floor.step();
  EXPECT_EQ(floor.robot("a").rendezvous_held(), 1);
}

TEST(RendezvousRobot, OfSeveralCallersAllAreServedInTheEnd) {
  Floor floor;
  floor.add("a", SE2());
  floor.add("b", SE2({0, 25}, 0));
  floor.add("c", SE2({10, 12}, 0));
  for (int k = 0; k < 18; ++k) {
    floor.move("a", 2);
    floor.move("b", 2);
  }
  for (int k = 0; k < 150; ++k) floor.step();
  EXPECT_LT(floor.robot("a").state().error, floor.robot("a").delta());
  EXPECT_LT(floor.robot("b").state().error, floor.robot("b").delta());
}

TEST(RendezvousRobot, IsWhereTheOtherSawItAfterwards) {
  Floor floor = lost_robot(10);
  for (int k = 0; k < 60 && floor.robot("a").rendezvous_held() == 0; ++k) floor.step();
  const auto trajectory = floor.robot("a").finish();
  EXPECT_EQ(trajectory.frame, "");
  EXPECT_LT((trajectory.rows.back().pose.translation() - floor.truth("a").translation()).norm(), 0.1);
  ASSERT_FALSE(trajectory.measurements.empty());
  EXPECT_GT(trajectory.measurements.front().weight, 0.9);
}

TEST(RendezvousRobot, ACallerWalksToAPartnerThatCannotMove) {
  Floor floor = lost_robot(20);
  floor.hold("b");
  for (int k = 0; k < 120 && floor.robot("a").rendezvous_held() == 0; ++k) floor.step();
  EXPECT_EQ(floor.robot("a").rendezvous_held(), 1);
}

TEST(RendezvousRobot, RobotsThatCannotExchangeDataPartAgain) {
  RendezvousParams params;
  params.q_db = 90;
  Floor floor(params);
  floor.add("a", SE2());
  floor.add("b", SE2({0, 6}, 0));
  for (int k = 0; k < 16; ++k) floor.move("a", 2);
  int explored = 0;
  for (int k = 0; k < 150; ++k) {
    floor.step();
    explored += floor.movement("a").kind == Movement::Kind::kExplore ? 1 : 0;
  }
  EXPECT_GT(explored, 50);
}

TEST(RendezvousRobot, UnderTheRandomPolicyNobodyCallsOrComes) {
  RendezvousParams params;
  params.policy = "random";
  Floor floor(params);
  floor.add("a", SE2());
  floor.add("b", SE2({0, 10}, 0));
  for (int k = 0; k < 16; ++k) floor.move("a", 2);
  for (int k = 0; k < 10; ++k) {
    floor.step();
    EXPECT_EQ(floor.movement("a").kind, Movement::Kind::kExplore);
    EXPECT_EQ(floor.movement("b").kind, Movement::Kind::kExplore);
  }
}

TEST(RendezvousRobot, ScheduledRobotsMeetAtTheirPlace) {
  RendezvousParams params;
  params.policy = "scheduled";
  Floor floor(params);
  floor.add("a", SE2({5, 5}, 1));
  floor.add("b", SE2({-8, 2}, 2));
  for (int k = 0; k < 34; ++k) floor.step();
  EXPECT_LT(floor.truth("a").translation().norm(), 1.6);
  EXPECT_LT(floor.truth("b").translation().norm(), 1.6);
}

}  // namespace
}  // namespace radioslam
