#include "radioslam/team/virtual_team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "radioslam/eval/team_estimate.hpp"
#include "radioslam/records/mission_of_logs.hpp"
#include "radioslam/sim/scenarios/city.hpp"

namespace radioslam {
namespace {

struct Town {
  RunParams params;
  Simulation simulated;

  Town() {
    CityParams city;
    city.robots = 3;
    city.path_length_m = 250;
    city.min_contact_s = 5;
    city.radio.links = 40;
    simulated = simulate_city(city, 3);
  }
};

const Town& town() {
  static const Town of;
  return of;
}

VirtualTeamSetup setup(NetworkFaults faults) {
  VirtualTeamSetup of{.dimension = 2, .run = town().params, .network = std::move(faults)};
  of.store = [](const std::string& robot) { return store_in_memory(robot, 1); };
  return of;
}

TeamRun live(NetworkFaults faults, const std::map<std::string, Kill>& killed = {}) {
  return run_team(scripted_robots(town().simulated.mission, town().params, killed), setup(std::move(faults)));
}

double error_of(const TeamRun& run, const std::string& agent) {
  TeamLog logs;
  for (const RobotLog& log : run.logs.at(agent)) logs.add(log);
  const RunResult result = run_pipeline(mission_of(logs), town().params).result;
  return evaluate_trajectories(team_estimate(result), town().simulated.truth, 2).ate->rmse_m;
}

double error_of_run() {
  static const double error_m = [] {
    const RunResult result = run_pipeline(town().simulated.mission, town().params).result;
    return evaluate_trajectories(team_estimate(result), town().simulated.truth, 2).ate->rmse_m;
  }();
  return error_m;
}

void expect_all_know_all(const TeamRun& run) {
  ASSERT_EQ(run.extents.size(), 3U);
  for (const auto& [agent, extents] : run.extents) EXPECT_EQ(extents, run.extents.at("a")) << agent;
  for (const auto& [agent, logs] : run.logs)
    for (std::size_t k = 0; k < logs.size(); ++k) EXPECT_EQ(logs[k].records, run.logs.at("a")[k].records);
}

TEST(VirtualTeam, EndsWhereARunEnds) {
  const TeamRun run = live({});
  expect_all_know_all(run);
  EXPECT_LE(error_of(run, "b"), 1.05 * error_of_run() + 0.02);
  EXPECT_GT(run.estimates, 10U);
  EXPECT_LT(run.computed, run.estimates);  // those of equal records are shared
}

TEST(VirtualTeam, IsNotHarmedByLossPartitionAndALateRobot) {
  NetworkFaults faults;
  faults.loss = 0.3;
  faults.partition = Partition{Stamp::from_seconds(5), Stamp::from_seconds(15)};
  faults.late["c"] = Stamp::from_seconds(12);
  const TeamRun run = live(faults);
  expect_all_know_all(run);
  EXPECT_LE(error_of(run, "c"), 1.05 * error_of_run() + 0.02);
  std::size_t lost = 0, messages = 0;
  for (const auto& [key, traffic] : run.traffic) {
    lost += traffic.lost;
    messages += traffic.messages;
  }
  EXPECT_GT(lost, messages / 4);
}

TEST(VirtualTeam, ARobotThatIsKilledGoesOnWithItsLog) {
  const std::map<std::string, Kill> killed{{"b", {Stamp::from_seconds(10), Stamp::from_seconds(12)}}};
  const auto script = scripted_robots(town().simulated.mission, town().params, killed);
  ASSERT_EQ(script[1].runs.size(), 2U);
  const TeamRun run = run_team(script, setup({}));
  expect_all_know_all(run);
  TeamLog logs;
  for (const RobotLog& log : run.logs.at("a")) logs.add(log);
  const LoggedMission logged = mission_of(logs);
  EXPECT_EQ(logged.mission.robots.size(), 3U);
  EXPECT_EQ(logged.mission.robots[1].odometry.back().stamp,
            town().simulated.mission.robots[1].odometry.back().stamp);
  EXPECT_LE(error_of(run, "a"), 2 * error_of_run());  // two of 23 s are missing
}

TEST(VirtualTeam, TheSameSeedGivesTheSameBytes) {
  NetworkFaults faults;
  faults.loss = 0.3;
  faults.seed = 7;
  const TeamRun one = live(faults), two = live(faults);
  EXPECT_EQ(one.extents, two.extents);
  ASSERT_EQ(one.known.size(), two.known.size());
  for (const auto& [key, traffic] : one.traffic) {
    EXPECT_EQ(traffic.bytes, two.traffic.at(key).bytes);
    EXPECT_EQ(traffic.lost, two.traffic.at(key).lost);
  }
}

}  // namespace
}  // namespace radioslam
