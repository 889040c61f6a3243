// Closures that come after the team was aligned, and judgements that are asked again.
#include <gtest/gtest.h>

#include "pipeline/town_runs.hpp"

namespace radioslam {
namespace {

/// A town with true matches; they are moved along the odometry to stamps between its samples.
Mission town(int dimension) {
  constexpr std::int64_t kShift_ns = 170'000'000;
  CityParams params = test::small_city(600);
  params.dimension = dimension;
  params.matches.matches_true = 20;
  params.matches.matches_false = 0;
  Mission mission = simulate_city(params, 4).mission;
  for (PoseMatch& match : mission.matches) {
    const auto shift = [&](RobotIndex robot, Stamp& stamp) {
      const Trajectory<SE3>& odometry = mission.robots[robot.index()].odometry;
      const Stamp later{stamp.ns + kShift_ns};
      if (!odometry.covers(later)) return SE3();
      const SE3 step = odometry.at(stamp)->inverse() * *odometry.at(later);
      stamp = later;
      return step;
    };
    match.T_i_j =
        shift(match.robot_i, match.stamp_i).inverse() * match.T_i_j * shift(match.robot_j, match.stamp_j);
  }
  return mission;
}

std::vector<VerifiedClosure> found_matches(const Mission& mission) {
  std::vector<VerifiedClosure> found;
  for (const Closure& match : closures_of_matches(mission)) found.push_back({match});
  return found;
}

template <class Pose>
class Judgement : public testing::Test {
 protected:
  static constexpr int kDimension = Pose::kDim;

  void SetUp() override {
    params = test::quick_params();
    params.optimizer.max_iterations = 100;
    params.optimizer.relative_cost_tolerance = 1e-12;
    mission = town(kDimension);
    late = mission;
    late.matches.clear();
    ASSERT_GT(mission.matches.size(), 10U);
  }

  /// Aligned without and with the matches.
  RunSetup setup(const Mission& of) { return {of, radio, params, options, progress, timed}; }
  TeamEstimate<Pose> aligned(const Mission& of) {
    return align_team(setup(of), build_team<Pose>(setup(of), nullptr, {}));
  }

  /// With all matches known from the start, and added to the aligned team.
  void expect_the_same() {
    const auto known = judge_closures(setup(mission), aligned(mission));
    const TeamEstimate<Pose> without = aligned(late);
    const auto later = judge_closures(setup(late), without, found_matches(mission));
    const auto& graph = later.team.joint.team.graph;
    ASSERT_EQ(graph.poses.size(), without.joint.team.graph.poses.size()) << "poses are keyframes";
    ASSERT_EQ(graph.poses.size(), known.team.joint.team.graph.poses.size());
    const double cost = total_cost(known.team.joint.team.graph);
    EXPECT_NEAR(total_cost(graph), cost, 1e-6 * cost);
    for (std::size_t k = 0; k < graph.poses.size(); ++k)
      EXPECT_LT((graph.poses[k].inverse() * known.team.joint.team.graph.poses[k]).log().norm(), 1e-3) << k;
    const auto &judged = later.team.judgement.closures.loops, &expected = known.team.judgement.closures.loops;
    ASSERT_EQ(judged.size(), expected.size());
    for (std::size_t k = 0; k < judged.size(); ++k) {
      EXPECT_EQ(judged[k].status, expected[k].status) << k;
      EXPECT_EQ(judged[k].reason, expected[k].reason) << k;
    }
  }

  RunParams params;
  RunOptions options;
  Progress progress;
  StageClock timed;
  Mission mission, late;
  RadioMeasurements radio = measure_radio({}, params.radio, {});
};
using Poses = testing::Types<SE2, SE3>;
TYPED_TEST_SUITE(Judgement, Poses);

TYPED_TEST(Judgement, IsTheSameForClosuresThatComeLate) { this->expect_the_same(); }

TYPED_TEST(Judgement, IsTheSameForLateClosuresOfATeamThatNothingElseConnects) {
  for (Mission* mission : {&this->mission, &this->late}) {
    mission->ranges.clear();
    mission->aoa_measurements.clear();
  }
  this->expect_the_same();
}

TYPED_TEST(Judgement, ChangesNothingWhenNothingIsNew) {
  const TeamEstimate<TypeParam> aligned = this->aligned(this->mission);
  const auto once = judge_closures(this->setup(this->mission), aligned);
  const auto again = judge_closures(this->setup(this->mission), aligned, {});
  const auto &poses = once.team.joint.team.graph.poses, &same = again.team.joint.team.graph.poses;
  ASSERT_EQ(poses.size(), same.size());
  for (std::size_t k = 0; k < poses.size(); ++k) EXPECT_EQ(poses[k].translation(), same[k].translation());
  auto solved = once.team.joint.team.graph;
  const double cost = total_cost(solved);
  optimize(solved, this->params.optimizer);
  EXPECT_NEAR(total_cost(solved), cost, 1e-6 * cost) << "what was judged is solved";
}

TYPED_TEST(Judgement, RejectsALateClosureOutsideTheOdometryAndSaysSo) {
  std::vector<VerifiedClosure> found = found_matches(this->mission);
  found.resize(5);
  found[2].closure.stamp_i = Stamp::from_seconds(1e6);
  const auto judged = judge_closures(this->setup(this->late), this->aligned(this->late), found);
  EXPECT_EQ(judged.team.judgement.closures.loops[2].reason, "no odometry at its time");
}

}  // namespace
}  // namespace radioslam
