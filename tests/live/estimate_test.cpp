#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "pipeline/small_carpark.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/front_end/replay.hpp"
#include "radioslam/joint/team_continuation.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/records/mission_of_logs.hpp"
#include "radioslam/records/record_codec.hpp"
#include "radioslam/sim/scenarios/city.hpp"

namespace radioslam {
namespace {

const Simulation& town() {
  static const Simulation simulated = [] {
    CityParams params;
    params.robots = 3;
    params.path_length_m = 250;
    params.min_contact_s = 5;
    params.radio.links = 40;
    return simulate_city(params, 3);
  }();
  return simulated;
}

/// What logs said by this time.
LoggedMission known_at(Stamp now, const std::vector<ReplayedRobot>& robots) {
  GrowingLogs logs;
  for (const ReplayedRobot& robot : robots)
    for (std::size_t k = 0; k < robot.known.size() && robot.known[k] <= now; ++k)
      logs.add(robot.log.robot, *decode_record(robot.log.records[k]));
  return logs.mission();
}

/// The town as it was known at this time.
LoggedMission known_at(Stamp now) {
  static const auto robots = replay(town().mission, {}, {});
  return known_at(now, robots);
}

Stamp end() { return town().mission.robots[0].odometry.back().stamp; }
Stamp at(double share) {
  const Stamp begin = town().mission.robots[0].odometry.front().stamp;
  return {begin.ns + Stamp::from_seconds(share * seconds_between(begin, end())).ns};
}

TeamSolution<SE2> estimated(const LoggedMission& logged, const TeamSolution<SE2>* last, Effort effort) {
  return estimate<SE2>({logged, {}}, last, effort, {});
}

double largest_move_m(const TeamSolution<SE2>& a, const TeamSolution<SE2>& b) {
  double largest = 0;
  const auto &before = a.team.joint.team.graph.poses, &now = b.team.joint.team.graph.poses;
  for (std::size_t k = 0; k < before.size(); ++k)
    largest = std::max(largest, (before[k].translation() - now[k].translation()).norm());
  return largest;
}

TEST(Estimate, StaysWhereNothingMoreIsKnown) {
  const LoggedMission known = known_at(end());
  const auto aligned = estimated(known, nullptr, Effort::kAlign);
  EXPECT_EQ(aligned.effort, Effort::kAlign);
  EXPECT_EQ(aligned.team.alignment.component, std::vector<int>(3, 0));
  const auto extended = estimated(known, &aligned, Effort::kExtend);
  EXPECT_EQ(extended.effort, Effort::kExtend);
  EXPECT_LT(largest_move_m(aligned, extended), 0.05);
  const auto judged = estimated(known, &extended, Effort::kJudge);
  EXPECT_EQ(judged.effort, Effort::kJudge);
  EXPECT_LT(largest_move_m(aligned, judged), 0.3);
}

/// Old keyframes keep their values, new ones follow the odometry.
TEST(Estimate, IsCarriedOverToMoreKeyframes) {
  const auto before = estimated(known_at(at(0.6)), nullptr, Effort::kAlign);
  const LoggedMission known = known_at(at(0.8));
  auto joint = build_joint_graph<SE2>(known.mission, {}, {});
  const auto by_odometry = joint.team.graph.poses;
  carry_values(before.team.joint, joint);
  for (std::size_t r = 0; r < joint.robots.size(); ++r) {
    const RobotVariables &old = before.team.joint.robots[r], &now = joint.robots[r];
    ASSERT_GT(now.poses.size(), old.poses.size());
    for (std::size_t k = 0; k < old.poses.size(); ++k) {
      EXPECT_EQ(old.stamps[k], now.stamps[k]);
      EXPECT_EQ(joint.team.graph.poses[now.poses[k].index()].translation(),
                before.team.joint.team.graph.poses[old.poses[k].index()].translation());
    }
    const std::size_t last = now.poses.back().index(), known_last = now.poses[old.poses.size() - 1].index();
    const SE2 moved = joint.team.graph.poses[known_last].inverse() * joint.team.graph.poses[last];
    const SE2 odometry = by_odometry[known_last].inverse() * by_odometry[last];
    EXPECT_LT((moved.inverse() * odometry).log().norm(), 1e-9);
  }
}

TEST(Estimate, ExtendsWithoutAnyClosureGettingLost) {
  const auto before = estimated(known_at(at(0.6)), nullptr, Effort::kAlign);
  const LoggedMission known = known_at(at(0.8));
  const auto team = extended(before.team, build_joint_graph<SE2>(known.mission, {}, {}));
  ASSERT_TRUE(team);
  const auto& factors = team->joint.origins.relative_poses;
  for (const FactorSource source : {FactorSource::kLoop, FactorSource::kSequence, FactorSource::kScanLoop})
    EXPECT_EQ(factors_of(factors, source).size(),
              factors_of(before.team.joint.origins.relative_poses, source).size());
  EXPECT_EQ(factors.size(), team->joint.team.graph.relative_poses.size());
  EXPECT_EQ(team->joint.origins.ranges.size(), team->joint.team.graph.ranges.size());
}

TEST(Estimate, OfOtherRobotsIsMadeAnew) {
  LoggedMission known = known_at(at(0.6));
  const auto before = estimated(known, nullptr, Effort::kAlign);
  known.mission.robots[2].id = "z";
  EXPECT_FALSE(extended(before.team, build_joint_graph<SE2>(known.mission, {}, {})));
  EXPECT_NE(estimated(known, &before, Effort::kExtend).effort, Effort::kExtend);
}

/// The car park's estimates at these shares of the mission, each judged from the one before.
std::vector<TeamSolution<SE2>> judged_carpark(const std::vector<double>& shares) {
  CarparkParams params = short_drives();
  params.robots = 3;
  const Mission mission = simulate_carpark(params, 5).mission;
  const auto robots = replay(mission, {}, {});
  const auto& odometry = mission.robots[0].odometry;
  const double whole_s = seconds_between(odometry.front().stamp, odometry.back().stamp);
  std::vector<TeamSolution<SE2>> solutions;
  for (const double share : shares) {
    const Stamp now{odometry.front().stamp.ns + Stamp::from_seconds(share * whole_s).ns};
    solutions.push_back(estimated(known_at(now, robots), solutions.empty() ? nullptr : &solutions.back(),
                                  solutions.empty() ? Effort::kAlign : Effort::kJudge));
  }
  return solutions;
}

TEST(Estimate, FitsFingerprintsAgainWhenTheyHaveGrownByHalf) {
  const auto solutions = judged_carpark({0.4, 0.45, 0.55, 0.7, 0.9});
  const auto fitted = [&](std::size_t k) { return solutions[k].radio->fitted; };
  for (std::size_t k = 1; k < solutions.size(); ++k)
    EXPECT_GT(solutions[k].radio->nodes.size(), solutions[k - 1].radio->nodes.size());
  EXPECT_EQ(fitted(0), solutions[0].radio->nodes.size());
  EXPECT_EQ(fitted(1), fitted(0));
  EXPECT_EQ(fitted(2), fitted(0));
  EXPECT_EQ(fitted(3), solutions[3].radio->nodes.size());
  EXPECT_EQ(fitted(4), fitted(3));
}

/// What was carried on is what comparing all from nothing gives, by the same models.
TEST(Estimate, CarriesWhatFingerprintsWereCompared) {
  for (const TeamSolution<SE2>& solution : judged_carpark({0.5, 0.52, 0.6, 0.72})) {
    const RadioMeasurements& radio = *solution.radio;
    ASSERT_TRUE(radio.near_similarity.joined_from());
    std::vector<Fingerprint> all;
    for (std::size_t n = 0; n < radio.nodes.size(); ++n) all.push_back(radio.at(n).fingerprint);
    RadioMeasurements anew = radio;
    anew.near_similarity = TeamSimilarity(all, SimilarityMeasure::kSorensen, {});
    const auto near = propose_near_closures(radio, 100, {}), near_anew = propose_near_closures(anew, 100, {});
    ASSERT_EQ(near.size(), near_anew.size());
    for (std::size_t k = 0; k < near.size(); ++k) {
      EXPECT_EQ(near[k].node_i, near_anew[k].node_i);
      EXPECT_EQ(near[k].node_j, near_anew[k].node_j);
      EXPECT_EQ(near[k].similarity, near_anew[k].similarity);
    }
    const auto& carried = solution.team.measured.sequences;
    const auto matched = match_sequences(anew, SequenceClosureParams{});
    ASSERT_EQ(carried.size(), matched.size());
    ASSERT_GT(carried.size(), 10U);
    for (std::size_t k = 0; k < matched.size(); ++k) {
      EXPECT_EQ(carried[k].candidate.node_i, matched[k].candidate.node_i);
      EXPECT_EQ(carried[k].candidate.node_j, matched[k].candidate.node_j);
      EXPECT_EQ(carried[k].fit.status, matched[k].fit.status);
      EXPECT_EQ(carried[k].fit.residual_m, matched[k].fit.residual_m);
      EXPECT_EQ(carried[k].fit.covariance, matched[k].fit.covariance);
    }
  }
}

TEST(Estimate, OfFingerprintsDoesNotDependOnTheNumberOfThreads) {
  const std::vector<double> shares{0.5, 0.6, 0.72, 1};
  set_thread_count(1);
  const auto one = judged_carpark(shares);
  set_thread_count(0);
  const auto many = judged_carpark(shares);
  for (std::size_t k = 0; k < shares.size(); ++k) EXPECT_EQ(largest_move_m(one[k], many[k]), 0);
}

/// Where two alignments are about as likely, the robots stay apart; else they share a frame.
TEST(Estimate, RobotsShareAFrameWhereAlignmentsAgree) {
  TeamEstimate<SE2> team = estimated(known_at(end()), nullptr, Effort::kAlign).team;
  team.alignment.alternatives.clear();
  team.alignment.alternative_weights.clear();
  team.alignment.weight = 0.6;
  auto other = team.joint.team.graph.poses;
  for (const PoseId pose : team.joint.robots[1].poses)
    other[pose.index()] = SE2({20, 0}, 0.5) * other[pose.index()];
  team.alignment.alternatives.push_back(other);
  team.alignment.alternative_weights.push_back(0.4);
  const auto apart = settled_components(team, 0.95);
  EXPECT_EQ(apart[2], apart[0]);
  EXPECT_NE(apart[1], apart[0]);
  EXPECT_EQ(settled_components(team, 0.5), std::vector<int>(3, 0));
}

}  // namespace
}  // namespace radioslam
