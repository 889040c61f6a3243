#include "radioslam/joint/sequence_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "joint/factors_by_measurement.hpp"
#include "pipeline/small_carpark.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/sim/scenarios/carpark.hpp"

namespace radioslam {
namespace {

/// Two robots on few lanes, driven by both.
CarparkParams shared_lanes() {
  CarparkParams params = short_drives();
  params.drive.path_length_m = 250;
  params.transmitters.access_points = 40;
  return params;
}

std::vector<ClosureResult> sequences_of(const RunResult& result) {
  std::vector<ClosureResult> sequences;
  for (const auto& closure : result.closures)
    if (closure.kind == ClosureKind::kSequence) sequences.push_back(closure);
  return sequences;
}

TEST(SequenceStage, AcceptedOnesHoldInTruth) {
  std::size_t accepted = 0, right = 0;
  for (const std::uint64_t seed : {11U, 12U, 13U}) {
    const Simulation simulation = simulate_carpark(shared_lanes(), seed);
    const Mission& mission = simulation.mission;
    const Truth& truth = simulation.truth;
    const auto radio = measure_radio(mission, {}, {});
    auto joint = build_joint_graph<SE2>(mission, {}, {});
    const std::size_t before = joint.team.graph.relative_poses.size();
    const auto closures = add_sequence_closures(joint, radio, match_sequences(2, radio, {}, nullptr), {});
    const auto factors =
        factors_by_measurement(joint.origins.relative_poses, FactorSource::kSequence, closures.size());
    for (std::size_t c = 0; c < closures.size(); ++c) {
      ASSERT_EQ(factors[c].has_value(), closures[c].judgement.status == ClosureStatus::kAccepted);
      if (!factors[c]) continue;
      // The factor's own measurement, between keyframes.
      const auto& factor = joint.team.graph.relative_poses[*factors[c]];
      const auto true_pose = [&](PoseId id) {
        for (std::size_t r = 0; r < joint.robots.size(); ++r)
          for (std::size_t k = 0; k < joint.robots[r].poses.size(); ++k)
            if (joint.robots[r].poses[k] == id)
              return flatten(*truth.robots[r].poses.at(joint.robots[r].stamps[k]));
        return SE2();
      };
      const SE2 gap = factor.T_i_j.inverse() * (true_pose(factor.i).inverse() * true_pose(factor.j));
      ++accepted;
      right += gap.translation().norm() <= 3 && std::abs(gap.angle()) <= 0.35 ? 1U : 0U;
    }
    EXPECT_GT(joint.team.graph.relative_poses.size(), before);
  }
  EXPECT_GE(accepted, 10U);
  EXPECT_GE(static_cast<double>(right), 0.9 * static_cast<double>(accepted));
}

TEST(SequenceStage, EveryCandidateReachesTheResult) {
  const auto mission = simulate_carpark(shared_lanes(), 14).mission;
  RunParams params;
  params.sequence.enabled = true;
  const auto sequences = sequences_of(run_pipeline(mission, params).result);
  const auto accepted = std::count_if(sequences.begin(), sequences.end(),
                                      [](const auto& c) { return c.status == ClosureStatus::kAccepted; });
  EXPECT_GT(accepted, 0);
  EXPECT_GT(sequences.size(), static_cast<std::size_t>(accepted));
  for (const auto& c : sequences) {
    EXPECT_EQ(c.reason.empty(), c.status == ClosureStatus::kAccepted);
    if (c.status == ClosureStatus::kAccepted) {
      EXPECT_LE(c.statistic, kPoseChiSquared99<SE2>);
    }
  }
}

TEST(SequenceStage, SwitchedOffThereAreNone) {
  const auto mission = simulate_carpark(shared_lanes(), 14).mission;
  RunParams params;
  params.sequence.enabled = false;
  EXPECT_TRUE(sequences_of(run_pipeline(mission, params).result).empty());
}

TEST(SequenceStage, NotesThatItSkipsThemInSpace) {
  CarparkParams params = short_drives();
  params.drive.path_length_m = 30;
  Mission mission = simulate_carpark(params, 11).mission;
  const auto says_so = [&](const RunParams& of) {
    const auto notes = run_pipeline(mission, of, {}, {}).result.notes;
    return std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
      return note.find("sequence closures were skipped") != std::string::npos;
    });
  };
  RunParams off;
  off.sequence.enabled = false;
  EXPECT_FALSE(says_so({}));
  mission.dimension = 3;
  EXPECT_TRUE(says_so({}));
  EXPECT_FALSE(says_so(off));
  for (Robot& robot : mission.robots) robot.wifi.clear();
  EXPECT_FALSE(says_so({}));
}

}  // namespace
}  // namespace radioslam
