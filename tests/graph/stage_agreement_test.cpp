#include "radioslam/graph/distributed/stage_agreement.hpp"

#include <gtest/gtest.h>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

/// Robots in a line, of which each acts in every round.
class Line {
 public:
  explicit Line(RobotNumber robots) {
    for (RobotNumber r = 0; r < robots; ++r) {
      std::vector<RobotNumber> neighbours;
      if (r > 0) neighbours.push_back(r - 1);
      if (r + 1 < robots) neighbours.push_back(r + 1);
      robots_.emplace_back(neighbours);
    }
  }
  /// A round with the activity of every robot; messages that `lost` names do not arrive.
  void round(const std::vector<Activity>& activities, std::uint32_t rounds_at_rest, RobotNumber lost = ~0U) {
    std::vector<StageNews> news;
    for (const auto& robot : robots_) news.push_back(robot.news());
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      auto& robot = robots_[r];
      for (const std::size_t n : {r - 1, r + 1})
        if (n < robots_.size() && n != lost) {
          EXPECT_TRUE(robot.hear(static_cast<RobotNumber>(n), news[n]));
        }
      if (const auto end = robot.heard_end()) robot.end(*end);
      const Activity activity = robot.together() ? activities[r] : Activity::kWaited;
      if (robot.count(activity, rounds_at_rest)) robot.end(StageEnd::kNext);
    }
  }
  const StageAgreement& operator[](std::size_t r) const { return robots_[r]; }

 private:
  std::vector<StageAgreement> robots_;
};

std::vector<Activity> all_rest(std::size_t robots) {
  return std::vector<Activity>(robots, Activity::kRested);
}

TEST(StageAgreement, EndsAStageOnlyAfterEverybodyHasRestedTogether) {
  constexpr std::size_t kRobots = 5;
  constexpr std::uint32_t kPatience = 4 + 2;
  Line line(kRobots);
  auto unsettled = all_rest(kRobots);
  unsettled[4] = Activity::kMoved;
  for (int k = 0; k < 30; ++k) line.round(unsettled, kPatience);
  for (std::size_t r = 0; r < kRobots; ++r) EXPECT_EQ(line[r].stage(), 0u);
  EXPECT_TRUE(line[0].moved());
  for (std::uint32_t k = 0; k < kPatience; ++k) {
    EXPECT_EQ(line[0].stage(), 0u) << k;
    line.round(all_rest(kRobots), kPatience);
  }
  for (std::size_t r = 0; r < kRobots; ++r) EXPECT_EQ(line[r].stage(), 1u);
  EXPECT_FALSE(line[0].moved());
}

TEST(StageAgreement, NeighboursAreNeverMoreThanOneStageApartWhateverTheyDo) {
  constexpr std::size_t kRobots = 6;
  Line line(kRobots);
  Rng rng(3);
  std::uint32_t last = 0;
  for (int k = 0; k < 4000; ++k) {
    auto activities = all_rest(kRobots);
    for (auto& activity : activities)
      if (rng.uniform() < 0.02) activity = Activity::kMoved;
    line.round(activities, 8);
    for (std::size_t r = 0; r + 1 < kRobots; ++r) {
      const std::uint32_t a = line[r].stage(), b = line[r + 1].stage();
      EXPECT_LE(std::max(a, b) - std::min(a, b), 1u);
    }
    EXPECT_GE(line[0].stage(), last);
    last = line[0].stage();
  }
  EXPECT_GT(last, 20u);
}

TEST(StageAgreement, ARobotThatIsNotHeardHoldsEverybodyUp) {
  Line line(3);
  for (int k = 0; k < 50; ++k) line.round(all_rest(3), 4, k % 3 == 0 ? 2 : ~0U);
  for (std::size_t r = 0; r < 3; ++r) EXPECT_EQ(line[r].stage(), 0u);
}

TEST(StageAgreement, RefusesANeighbourThatCannotBeSoFar) {
  StageAgreement robot({1});
  EXPECT_FALSE(robot.hear(1, {2, 0, false, false}));
  EXPECT_FALSE(robot.hear(7, {0, 0, false, false}));
  EXPECT_TRUE(robot.hear(1, {1, 0, false, false}));
  EXPECT_EQ(robot.heard_end(), StageEnd::kNext);
}

TEST(StageAgreement, TheEndSpreads) {
  StageAgreement robot({1, 2});
  EXPECT_TRUE(robot.hear(1, {0, 3, true, false}));
  EXPECT_TRUE(robot.hear(2, {0, 9, false, true}));
  ASSERT_EQ(robot.heard_end(), StageEnd::kFinish);
  robot.end(StageEnd::kFinish);
  EXPECT_TRUE(robot.news().finished);
}

TEST(StageAgreement, NewsTravelsAsBytes) {
  Message<SE2> message;
  message.stage = StageNews{300, 5, true, false};
  const std::string bytes = encode(message);
  const auto decoded = decode<SE2>(bytes);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->stage, message.stage);
  for (std::size_t k = 0; k < bytes.size(); ++k) EXPECT_FALSE(decode<SE2>(bytes.substr(0, k)) && k > 7) << k;
  std::string unknown_flag = bytes;
  unknown_flag.back() = 4;
  EXPECT_FALSE(decode<SE2>(unknown_flag));
}

}  // namespace
}  // namespace radioslam
