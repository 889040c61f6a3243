#include "radioslam/study/distributed_optimization/distributed_study.hpp"

#include <gtest/gtest.h>

#include "radioslam/study/distributed_optimization/simulated_teams.hpp"
#include "radioslam/study/study_json.hpp"
#include "radioslam/study/study_page.hpp"

namespace radioslam {
namespace {

TEST(DistributedStudy, ComparesEveryMethodWithTheCentralOptimum) {
  const DistributedTeam team = study_distributed_team("blocks", simulate_blocks(1, 2, 3, 1));
  EXPECT_EQ(team.robots, 2U);
  EXPECT_EQ(team.poses, 18U);
  ASSERT_EQ(team.runs.size(), kDistributedMethods.size() + 1);
  for (const DistributedRun& run : team.runs) {
    EXPECT_EQ(run.bytes.size(), run.outcome.gaps.size()) << run.method;
    EXPECT_EQ(run.bytes.back(), run.outcome.traffic.bytes()) << run.method;
    if (run.method == "alternating") continue;  // need not reach it
    ASSERT_TRUE(run.outcome.rounds_to_optimum) << run.method;
    EXPECT_EQ(run.outcome.bytes_to_optimum, run.bytes[*run.outcome.rounds_to_optimum - 1]) << run.method;
  }
  EXPECT_LT(team.runs.front().outcome.rounds_to_optimum, 10U);

  EXPECT_EQ(distributed_table({team}).rows.size(), team.runs.size());
  const auto json = distributed_optimization_json({team});
  const auto& run = json["teams"][0]["runs"][0];
  EXPECT_EQ(run["trace"].back()[0], run["rounds"]);
  EXPECT_EQ(run["trace"].back()[1], run["bytes"]);
  EXPECT_NE(render_distributed_page({team}).find("\"distributed\""), std::string::npos);
}

TEST(DistributedStudy, SimulatesLapsThatFewClosuresTieTogether) {
  const TeamGraph<SE3> laps = simulate_laps(4, 1);
  const auto team = number_robots(laps);
  const auto closures = laps.graph.relative_poses.size() + team.names.size() - laps.graph.poses.size();
  EXPECT_EQ(team.names.size(), 4U);
  EXPECT_GT(closures, 8U);
  EXPECT_LT(20 * closures, laps.graph.poses.size());
  std::vector<bool> tied(4, false);
  for (const auto& f : laps.graph.relative_poses) {
    const auto i = team.poses.robot_of[f.i.index()], j = team.poses.robot_of[f.j.index()];
    if (i != j) tied[i] = tied[j] = true;
  }
  EXPECT_EQ(tied, std::vector<bool>(4, true));
  EXPECT_EQ(simulate_laps(4, 1).graph.relative_poses.back().T_i_j.translation(),
            laps.graph.relative_poses.back().T_i_j.translation());
}

}  // namespace
}  // namespace radioslam
