#include "radioslam/study/fingerprints/sequence_table.hpp"

#include <gtest/gtest.h>

#include "pipeline/small_carpark.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/study/study_json.hpp"

namespace radioslam {
namespace {

TEST(SequenceTable, EveryCellSeesEveryMission) {
  const auto cells = measure_sequence_closures(simulated_carparks(short_drives(), 3, 1));
  ASSERT_EQ(cells.size(), 36U);
  std::size_t accepted = 0;
  for (const SequenceCell& cell : cells) {
    EXPECT_EQ(cell.missions, 1U);
    EXPECT_LE(cell.accepted.size(), cell.candidates);
    accepted += cell.accepted.size();
  }
  EXPECT_GT(accepted, 0U);
  EXPECT_GE(cells[0].candidates, cells[8].candidates) << "a higher threshold leaves fewer";
  EXPECT_EQ(sequence_table(cells, "Seed 3").rows.size(), 36U);
}

TEST(SequenceTable, ErrorsAreThoseOfTheTruth) {
  const Simulation simulation = simulate_carpark(short_drives(), 5);
  const Truth& truth = simulation.truth;
  const auto radio = measure_radio(simulation.mission, {}, {});
  SequenceClosure closure{{3, radio.nodes.size() - 4, 0.9}, {}};
  const auto pose = [&](std::size_t node) {
    return flatten(*truth.robots[radio.nodes[node].robot.index()].poses.at(radio.at(node).fingerprint.stamp));
  };
  const SE2 T_j_i = pose(closure.candidate.node_j).inverse() * pose(closure.candidate.node_i);
  closure.fit.status = SequenceStatus::kAccepted;
  closure.fit.T_j_i = T_j_i * SE2({0.3, 0.4}, 0);
  closure.fit.covariance = 0.25 * Eigen::Matrix3d::Identity();
  SequenceClosure refused = closure;
  refused.fit.status = SequenceStatus::kResidual;
  const auto errors = sequence_errors(radio, truth, {refused, closure});
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NEAR(errors[0].distance_m, 0.5, 1e-9);
  EXPECT_NEAR(errors[0].angle_rad.value(), 0, 1e-9);
  EXPECT_NEAR(errors[0].nees.value(), 1, 1e-9);
  EXPECT_TRUE(errors[0].right());
  EXPECT_FALSE((SequenceError{3.1, 0, 0}.right()));
  EXPECT_FALSE((SequenceError{0, 0.36, 0}.right()));
}

TEST(SequenceTable, TakesWaypointsAsTheTruth) {
  Simulation simulation = simulate_carpark(short_drives(), 5);
  const auto radio = measure_radio(simulation.mission, {}, {});
  SequenceClosure closure{{3, radio.nodes.size() - 4, 0.9}, {}};
  Truth& truth = simulation.truth;
  const auto place = [&](std::size_t node) {
    const auto& of = truth.robots[radio.nodes[node].robot.index()].poses;
    return flatten(*of.at(radio.at(node).fingerprint.stamp)).translation();
  };
  const double distance_m = (place(closure.candidate.node_j) - place(closure.candidate.node_i)).norm();
  closure.fit.status = SequenceStatus::kAccepted;
  closure.fit.T_j_i = SE2({0, distance_m + 2}, 1);
  closure.fit.covariance = Eigen::Matrix3d::Identity();
  for (RobotTruth& robot : truth.robots) robot.has_orientation = false;
  const auto errors = sequence_errors(radio, truth, {closure});
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NEAR(errors[0].distance_m, 2, 1e-9) << "whatever the direction";
  EXPECT_FALSE(errors[0].angle_rad || errors[0].nees);
  EXPECT_TRUE(errors[0].right());
  const StudyTable table = sequence_table({{0.3, 30, 1, 1, errors, 0, "slide"}}, "Mission floor");
  EXPECT_EQ(table.rows[0].label, "slide, window 30 m, similarity 0.3");
  EXPECT_EQ(table.rows[0].cells, (std::vector<std::string>{"1", "1.0", "100.0 %", "2.00", "–", "–"}));
  for (RobotTruth& robot : truth.robots) robot.poses = {};
  EXPECT_TRUE(sequence_errors(radio, truth, {closure}).empty()) << "the truth does not cover it";
}

TEST(SequenceTable, CountsTheCells) {
  const SequenceCell cell{0.3, 30, 2, 10, {{1, 0.1, 3}, {2, 0.2, 6}, {5, 0, 30}}};
  const StudyTable table = sequence_table({cell}, "Seed 1");
  EXPECT_EQ(table.rows[0].label, "window 30 m, similarity 0.3");
  EXPECT_EQ(table.rows[0].cells, (std::vector<std::string>{"5", "1.5", "66.7 %", "2.00", "5.7", "2.00"}));
  EXPECT_EQ(sequence_json({cell})["cells"][0]["accepted"][2]["right"], false);
}

TEST(SequenceTable, IsTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const auto alone =
      sequence_json(measure_sequence_closures(simulated_carparks(short_drives(), 4, 1))).dump();
  set_thread_count(3);
  const auto together =
      sequence_json(measure_sequence_closures(simulated_carparks(short_drives(), 4, 1))).dump();
  set_thread_count(0);
  EXPECT_EQ(alone, together);
}

}  // namespace
}  // namespace radioslam
