#include "radioslam/live/team_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "radioslam/base/parallel.hpp"
#include "radioslam/sim/scenarios/city.hpp"

namespace radioslam {
namespace {

CityParams town() {
  CityParams params;
  params.robots = 3;
  params.path_length_m = 250;
  params.min_contact_s = 5;
  params.radio.links = 40;
  return params;
}

StreamedTeam stream(const Simulation& simulated) {
  const RunParams params;
  const auto robots = replay(simulated.mission, params.scans, params.keyframe);
  const auto error_of = [&](const std::vector<EstimatedTrajectory>& team) -> std::optional<double> {
    const auto ate = evaluate_trajectories(team, simulated.truth, simulated.mission.dimension).ate;
    return ate ? std::optional(ate->rmse_m) : std::nullopt;
  };
  return stream_team(simulated.mission, robots, params, {}, error_of);
}

/// A town, streamed once for several tests.
struct Town {
  Simulation simulated = simulate_city(town(), 3);
  StreamedTeam team = stream(simulated);
};

const Town& streamed_town() {
  static const Town town;
  return town;
}

TEST(TeamStream, RobotsComeToShareAFrameAndStayThere) {
  const auto& [simulated, team] = streamed_town();
  ASSERT_FALSE(team.estimates.empty());
  const OnlineEstimate& last = team.estimates.back();
  EXPECT_EQ(last.frame, std::vector<std::size_t>(simulated.mission.robots.size(), 0));
  const auto compared = std::find_if(team.estimates.rbegin(), team.estimates.rend(),
                                     [](const auto& estimate) { return estimate.error_m.has_value(); });
  ASSERT_NE(compared, team.estimates.rend());
  EXPECT_LT(*compared->error_m, 5);
  const auto joins = std::count_if(team.events.begin(), team.events.end(), [](const auto& event) {
    return event.what.find("is in the frame of robot a") != std::string::npos;
  });
  EXPECT_EQ(joins, static_cast<long>(simulated.mission.robots.size()) - 1);
}

TEST(TeamStream, SaysWhereAFrameStandsOnClosuresAlone) {
  const auto is_by_closures = [](const TeamEvent& event) {
    return event.is_join && event.what.find("by closures alone") != std::string::npos;
  };
  const auto& with_links = streamed_town().team.events;
  EXPECT_TRUE(std::none_of(with_links.begin(), with_links.end(), is_by_closures));
  CityParams seen = town();
  seen.matches.matches_true = 60;
  Simulation simulated = simulate_city(seen, 3);
  simulated.mission.ranges.clear();
  simulated.mission.aoa_measurements.clear();
  const auto without = stream(simulated).events;
  const auto joins = std::count_if(without.begin(), without.end(), [](const auto& e) { return e.is_join; });
  EXPECT_GT(joins, 0);
  EXPECT_EQ(std::count_if(without.begin(), without.end(), is_by_closures), joins);
}

TEST(TeamStream, ClosuresAloneDoNotJoinFramesWhereThereIsRadio) {
  CityParams seen = town();
  seen.matches.matches_true = 60;
  Simulation simulated = simulate_city(seen, 3);
  auto& ranges = simulated.mission.ranges;
  auto& angles = simulated.mission.aoa_measurements;
  // Links between robots b and c alone are left.
  std::erase_if(ranges, [](const auto& of) { return std::min(of.i.robot.index(), of.j.robot.index()) == 0; });
  std::erase_if(angles,
                [](const auto& of) { return of.receiver.index() == 0 || of.transmitter.robot.index() == 0; });
  ASSERT_FALSE(ranges.empty());
  const auto team = stream(simulated);
  const std::vector<std::size_t>& frame = team.estimates.back().frame;
  EXPECT_NE(frame[1], 0u);
  EXPECT_NE(frame[2], 0u);
  EXPECT_TRUE(std::any_of(team.events.begin(), team.events.end(), [](const auto& event) {
    return event.what.find("until radio links agree") != std::string::npos;
  }));
}

TEST(TeamStream, EveryKeyframeOfTheLogsIsSaidOnceInTimeOrder) {
  const auto& [simulated, team] = streamed_town();
  std::vector<std::uint32_t> next(simulated.mission.robots.size(), 0);
  for (const OnlineKeyframe& keyframe : team.keyframes) EXPECT_EQ(keyframe.number, next[keyframe.robot]++);
  for (std::size_t k = 1; k < team.estimates.size(); ++k)
    EXPECT_GE(seconds_between(team.estimates[k - 1].at, team.estimates[k].at), 1);
}

/// A frame is where an estimate put it, until the next one: keyframes in between follow the odometry.
TEST(TeamStream, AKeyframeFollowsTheOdometrySinceTheLastEstimate) {
  const auto& [simulated, team] = streamed_town();
  const Trajectory<SE3>& odometry = simulated.mission.robots[0].odometry;
  const OnlineKeyframe* before = nullptr;
  for (const OnlineKeyframe& keyframe : team.keyframes) {
    if (keyframe.robot != 0) continue;
    if (before && before->estimate == keyframe.estimate) {
      const SE2 by_odometry =
          flatten(*odometry.at(before->stamp)).inverse() * flatten(*odometry.at(keyframe.stamp));
      const SE2 online = flatten(before->T_frame_body).inverse() * flatten(keyframe.T_frame_body);
      EXPECT_LT((by_odometry.inverse() * online).log().norm(), 1e-6);
    }
    before = &keyframe;
  }
}

TEST(TeamStream, DoesNotDependOnTheNumberOfThreads) {
  const Simulation simulated = simulate_city(town(), 4);
  set_thread_count(1);
  const StreamedTeam one = stream(simulated);
  set_thread_count(0);
  const StreamedTeam many = stream(simulated);
  ASSERT_EQ(one.keyframes.size(), many.keyframes.size());
  for (std::size_t k = 0; k < one.keyframes.size(); ++k) {
    EXPECT_EQ(one.keyframes[k].T_frame_body.translation(), many.keyframes[k].T_frame_body.translation());
    EXPECT_EQ(one.keyframes[k].frame, many.keyframes[k].frame);
  }
  ASSERT_EQ(one.events.size(), many.events.size());
  for (std::size_t k = 0; k < one.events.size(); ++k) EXPECT_EQ(one.events[k].what, many.events[k].what);
}

}  // namespace
}  // namespace radioslam
