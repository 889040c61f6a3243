// A compressed team graph has the same optimum and the same covariances as the full one.
#include "radioslam/team_frame/odometry_compression.hpp"

#include <gtest/gtest.h>

#include "graph/random_graphs.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kPoses = 12;  // per segment, of two

/// Two trajectories with one drift each: a relative pose between 2 and 9 of the first, ranges from 4 and 8 to
/// the second's 3 and 10 and to a point that its 6 sights, and a prior on the first pose.
template <class Pose>
class TeamDrawing {
 public:
  TeamDrawing(std::uint64_t seed, double noise) : draw_(seed), noise_(noise) {}

  TeamGraph<Pose> run() {
    add_segment("a");
    add_segment("b");
    auto& graph = team_.graph;
    graph.points = {draw_.point(10)};
    graph.pose_priors.push_back({PoseId(0), graph.poses[0], Pose::Jacobian::Identity() * 1e4, {}, 1});
    relative(2, 9, {});
    relative(4, kPoses + 3, {});
    range({PoseId(8), {}, draw_.point(0.2)}, {PoseId(kPoses + 10), {}, draw_.point(0.2)});
    range({PoseId(8), {}, Pose::Point::Zero()}, {{}, PointId(0), Pose::Point::Zero()});
    RelativePointFactor<Pose> sighting;
    sighting.i = PoseId(kPoses + 6);
    sighting.j.point = PointId(0);
    sighting.position = graph.poses[kPoses + 6].inverse() * graph.points[0] + draw_.point(noise_);
    graph.relative_points.push_back(sighting);
    team_.bearings.push_back(
        {PoseId(kPoses + 3), {PoseId(4), {}, Pose::Point::Zero()}, {{Pose::Point::UnitX(), 0.1, -50}}});
    for (std::size_t d = 0; d < 2; ++d)
      graph.drift_priors.push_back({DriftId(d), Drift::Zero(), Eigen::Matrix2d::Identity() * 100});
    return team_;
  }

 private:
  void add_segment(const std::string& robot) {
    auto& graph = team_.graph;
    TrajectorySegment segment{robot, graph.poses.size(), kPoses, {}};
    const DriftId drift(graph.drifts.size());
    graph.drifts.emplace_back(Drift::Zero());
    for (std::size_t k = 0; k < kPoses; ++k) {
      segment.stamps.push_back(Stamp::from_seconds(static_cast<double>(k)));
      const Pose step = draw_.pose(0.3, 0.4) * Pose::exp(Pose::Tangent::Unit(0) * 2.0);
      graph.poses.push_back(k == 0 ? draw_.pose(5, 0.5) : graph.poses.back() * step);
      if (k > 0) relative(graph.poses.size() - 2, graph.poses.size() - 1, drift);
    }
    team_.segments.push_back(segment);
  }
  void relative(std::size_t i, std::size_t j, DriftId drift) {
    auto& graph = team_.graph;
    RelativePoseFactor<Pose> factor;
    factor.i = PoseId(i);
    factor.j = PoseId(j);
    factor.T_i_j = graph.poses[i].inverse() * graph.poses[j] * draw_.pose(noise_, noise_);
    factor.information = 100 * draw_.template information<Pose::kDof>();
    factor.drift = drift;
    if (drift.valid())
      for (int c = 0; c < 2; ++c) factor.drift_jacobian.col(c) = draw_.template normals<Pose::kDof>(0.3);
    graph.relative_poses.push_back(factor);
  }
  void range(const RangeEnd<Pose>& i, const RangeEnd<Pose>& j) {
    const auto& graph = team_.graph;
    const auto place = [&](const RangeEnd<Pose>& end) -> typename Pose::Point {
      if (!end.pose.valid()) return graph.points[0];
      return graph.poses[end.pose.index()] * end.lever_arm;
    };
    team_.graph.ranges.push_back(
        {i, j, (place(j) - place(i)).norm() + noise_ * draw_.rng.normal(), 0.1, {}, 1});
  }

  test::Drawing<Pose> draw_;
  double noise_;
  TeamGraph<Pose> team_;
};

template <class Pose>
class CompressedTeamOf : public testing::Test {};
TYPED_TEST_SUITE(CompressedTeamOf, test::PoseTypes);

const std::vector<std::size_t> kKept{0, 2, 4, 8, 9, kPoses, kPoses + 3, kPoses + 6, kPoses + 10};

TYPED_TEST(CompressedTeamOf, KeepsFirstPosesAndThoseThatAreTied) {
  const auto compressed = compress(TeamDrawing<TypeParam>(1, 0).run());
  std::vector<std::size_t> kept;
  for (const PoseId id : compressed.full_pose) kept.push_back(id.index());
  EXPECT_EQ(kept, kKept);
  ASSERT_EQ(compressed.team.segments.size(), 2U);
  EXPECT_EQ(compressed.team.segments[0].pose_count, 5U);
  EXPECT_EQ(compressed.team.segments[1].first_pose, 5U);
  EXPECT_EQ(compressed.team.segments[1].robot, "b");
  EXPECT_EQ(compressed.team.segments[1].stamps[1], Stamp::from_seconds(3));
  EXPECT_EQ(compressed.team.bearings[0].i, PoseId(6));
  EXPECT_EQ(compressed.team.bearings[0].j.pose, PoseId(2));
  EXPECT_EQ(compressed.team.graph.relative_poses.size(), 7U + 2U);
}

TYPED_TEST(CompressedTeamOf, HasTheFullGraphsMarginalCovariances) {
  const auto full = TeamDrawing<TypeParam>(2, 0).run();
  const auto compressed = compress(full);
  const auto of_full = Marginals<TypeParam>::compute(full.graph);
  const auto of_compressed = Marginals<TypeParam>::compute(compressed.team.graph);
  ASSERT_TRUE(of_full && of_compressed);
  for (std::size_t k = 0; k < compressed.full_pose.size(); ++k) {
    const typename TypeParam::Jacobian expected = of_full->pose(compressed.full_pose[k]);
    EXPECT_LT((of_compressed->pose(PoseId(k)) - expected).norm(), 1e-8 * expected.norm()) << k;
  }
  EXPECT_LT((of_compressed->relative_pose(PoseId(3), PoseId(7)) -
             of_full->relative_pose(compressed.full_pose[3], compressed.full_pose[7]))
                .norm(),
            1e-8 * of_full->relative_pose(compressed.full_pose[3], compressed.full_pose[7]).norm());
  for (std::size_t d = 0; d < 2; ++d)
    EXPECT_LT((of_compressed->drift(DriftId(d)) - of_full->drift(DriftId(d))).norm(), 1e-8);
  EXPECT_LT((of_compressed->point(PointId(0)) - of_full->point(PointId(0))).norm(), 1e-8);
}

TYPED_TEST(CompressedTeamOf, HasTheFullGraphsOptimum) {
  auto full = TeamDrawing<TypeParam>(3, 1e-4).run();
  auto compressed = compress(full);
  const auto before = full.graph.poses;
  optimize(full.graph, {});
  optimize(compressed.team.graph, {});
  double moved = 0;
  for (std::size_t k = 0; k < compressed.full_pose.size(); ++k) {
    const std::size_t f = compressed.full_pose[k].index();
    moved = std::max(moved, (before[f].inverse() * full.graph.poses[f]).log().norm());
    EXPECT_LT((compressed.team.graph.poses[k].inverse() * full.graph.poses[f]).log().norm(), 1e-6) << k;
  }
  EXPECT_GT(moved, 5e-5) << "the task is too easy";
  for (std::size_t d = 0; d < 2; ++d)
    EXPECT_LT((compressed.team.graph.drifts[d] - full.graph.drifts[d]).norm(), 1e-6);
  EXPECT_LT((compressed.team.graph.points[0] - full.graph.points[0]).norm(), 1e-6);
}

TYPED_TEST(CompressedTeamOf, PosesInBetweenFollowByTheirOdometry) {
  const auto drawn = TeamDrawing<TypeParam>(4, 0).run();
  auto compressed = compress(drawn);
  test::Drawing<TypeParam> draw(5);
  for (auto& pose : compressed.team.graph.poses) pose = draw.pose(20, 1);
  compressed.team.graph.points[0].setConstant(7);
  compressed.team.graph.drifts[1] = Drift(0.1, 0.2);
  auto full = drawn;
  expand_values(compressed, full);
  for (std::size_t k = 0; k < kKept.size(); ++k)
    EXPECT_LT((full.graph.poses[kKept[k]].inverse() * compressed.team.graph.poses[k]).log().norm(), 1e-12);
  for (const std::size_t k : {std::size_t{5}, std::size_t{7}, 2 * kPoses - 1}) {
    const std::size_t factor = k < kPoses ? k - 1 : k - 2;
    EXPECT_LT(
        (full.graph.poses[k].inverse() * full.graph.poses[k - 1] * drawn.graph.relative_poses[factor].T_i_j)
            .log()
            .norm(),
        1e-9)
        << k;
  }
  EXPECT_EQ(full.graph.points[0], compressed.team.graph.points[0]);
  EXPECT_EQ(full.graph.drifts[1], Drift(0.1, 0.2));
}

TEST(CompressedTeam, ASegmentWithoutOdometryEndsTheProgram) {
  auto team = TeamDrawing<SE2>(6, 0).run();
  team.graph.relative_poses.erase(team.graph.relative_poses.begin());
  EXPECT_DEATH(compress(team), "need odometry");
}

}  // namespace
}  // namespace radioslam
