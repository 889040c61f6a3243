#include "radioslam/report/live/live_changes.hpp"

#include <gtest/gtest.h>

#include <random>

#include "radioslam/report/live/live_page.hpp"

namespace radioslam {
namespace {

/// What a page has after the changes, by the rules of live_changes.hpp.
struct Page {
  std::vector<std::map<std::string, std::vector<long>>> robots;
  std::map<std::string, std::vector<std::size_t>> lines;
  std::size_t clouds = 0, events = 0;

  void take(const PageData& change) {
    if (change.contains("whole")) *this = {};
    for (const PageData& robot : change["robots"]) {
      const std::size_t r = robot["robot"], count = robot["count"], from = robot["from"];
      if (robots.size() <= r) robots.resize(r + 1);
      for (const char* key : {"t", "x", "y", "heading"}) {
        auto& column = robots[r][key];
        column.resize(count);
        long at = from > 0 ? column[from - 1] : 0;
        for (std::size_t k = 0; k < robot[key].size(); ++k)
          column[from + k] = at += robot[key][k].get<long>();
      }
    }
    if (change.contains("lines"))
      for (const char* key : {"group", "robot_i", "keyframe_i", "robot_j", "keyframe_j"}) {
        lines[key].resize(change["lines"]["from"]);
        for (const PageData& value : change["lines"][key]) lines[key].push_back(value);
      }
    clouds += change["clouds"].size();
    events += change["events"].size();
  }
  bool operator==(const Page&) const = default;
};

/// A team of two that grows; what it has measured moves, and is judged anew now and then.
LiveTeam team_at(int n) {
  std::mt19937 random(static_cast<unsigned>(n));
  const auto noise = [&] { return 1e-3 * static_cast<double>(random() % 100); };
  LiveTeam team;
  team.self = "a";
  team.now = Stamp::from_seconds(n);
  const double jump = n > 12 ? 5 : 0;
  for (int r = 0; r < (n < 4 ? 1 : 2); ++r) {
    LiveRobot robot{.id = r == 0 ? "a" : "b", .frame = r == 0 || n < 8 ? "a" : "b", .poses = {}};
    for (int k = 0; k < 3 * n; ++k)
      robot.poses.push_back(
          {Stamp::from_seconds(k / 3.0), {0.3 * k + noise() + (r == 1 ? jump : 0), noise(), 0}, 0.01 * k});
    team.robots.push_back(robot);
  }
  for (int k = 0; k < n; ++k)
    team.lines.push_back({ClosureKind::kRange,
                          (k * k + n / 5) % 7 < 5 ? ClosureStatus::kAccepted : ClosureStatus::kRejected, 0,
                          static_cast<std::size_t>(k), 0, static_cast<std::size_t>(2 * k)});
  for (const LiveLine& line : team.lines) ++team.closures[{line.kind, line.status}];
  for (int k = 0; k < n; ++k) {
    auto cloud = std::make_shared<LiveCloud>();
    cloud->points = {{1, 2, 3}};
    team.clouds.push_back(cloud);
    team.events.emplace_back(Stamp::from_seconds(k), "event");
  }
  return team;
}

TEST(LiveChanges, GiveTheWholeWhenTheyAreApplied) {
  LiveChanges changes;
  Page page;
  for (int n = 1; n < 20; ++n) {
    page.take(changes.next(team_at(n)));
    Page fresh;
    fresh.take(changes.whole());
    EXPECT_EQ(page, fresh) << n;
  }
  EXPECT_EQ(page.clouds, 19u);
}

TEST(LiveChanges, AreWhatThePosesAreUpToTheirRounding) {
  LiveChanges changes;
  Page page;
  for (int n = 1; n < 20; ++n) {
    const LiveTeam team = team_at(n);
    page.take(changes.next(team));
    for (std::size_t r = 0; r < team.robots.size(); ++r) {
      const auto& poses = team.robots[r].poses;
      ASSERT_EQ(page.robots[r]["x"].size(), poses.size());
      for (std::size_t k = 0; k < poses.size(); ++k) {
        EXPECT_NEAR(LiveChanges::kStep_m * static_cast<double>(page.robots[r]["x"][k]),
                    poses[k].position_m.x(), LiveChanges::kStep_m);
        EXPECT_NEAR(LiveChanges::kStep_s * static_cast<double>(page.robots[r]["t"][k]),
                    static_cast<double>(k) / 3, LiveChanges::kStep_s);
      }
    }
  }
}

TEST(LiveChanges, AreSmallWhereLittleChanges) {
  LiveTeam team = team_at(3);
  for (int k = 0; k < 10'000; ++k)
    team.robots[0].poses.push_back({Stamp::from_seconds(3 + k), {0.3 * k, 0, 0}, 0});
  LiveChanges changes;
  EXPECT_GT(changes.next(team).dump().size(), 80'000u);
  EXPECT_TRUE(changes.next(team)["robots"].empty());
  for (LivePose& pose : team.robots[0].poses) pose.position_m.x() += 0.4 * LiveChanges::kStep_m;
  team.robots[0].poses.push_back({Stamp::from_seconds(20'000), {0, 0, 0}, 0});
  const PageData one = changes.next(team);
  EXPECT_LT(one.dump().size(), 1500u) << "poses that moved less than their rounding stay";
  EXPECT_EQ(one["robots"][0]["x"].size(), 1u);
  EXPECT_FALSE(one.contains("lines"));
}

TEST(LiveChanges, ShowEverySecondPoseOfTooMany) {
  LiveTeam team = team_at(1);
  for (std::size_t k = 0; k < LiveChanges::kMostPoses + 10; ++k)
    team.robots[0].poses.push_back({Stamp::from_seconds(1 + static_cast<double>(k)), {0, 0, 0}, 0});
  team.lines = {{ClosureKind::kRange, ClosureStatus::kAccepted, 0, 7, 0, 100}};
  LiveChanges changes;
  const PageData data = changes.next(team);
  EXPECT_EQ(data["robots"][0]["count"], (LiveChanges::kMostPoses + 13 + 1) / 2);
  EXPECT_EQ(data["lines"]["keyframe_i"][0], 3);
  EXPECT_EQ(data["lines"]["keyframe_j"][0], 50);
}

TEST(LivePage, HasNoNameThatEndsItsElement) {
  const std::string page = live_page_of("</script><script>alert(1)</script>", 2, "NONCE");
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find("@nonce@"), std::string::npos);
  EXPECT_NE(page.find("<script nonce=\"NONCE\">"), std::string::npos);
  EXPECT_EQ(page.find("http-equiv"), std::string::npos) << "the server has the policy";
}

}  // namespace
}  // namespace radioslam
