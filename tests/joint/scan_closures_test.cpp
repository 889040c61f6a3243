#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "joint/factors_by_measurement.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/joint/closures/closure.hpp"

namespace radioslam {
namespace {

constexpr double kSide_m = 20;
constexpr int kRowsPerSide = 20;

/// Once around a square and back to the starting corner.
std::vector<SE3> around_a_square() {
  std::vector<SE3> poses{SE3()};
  for (int side = 0; side < 4; ++side) {
    for (int k = 0; k < kRowsPerSide; ++k)
      poses.push_back(poses.back() * lift(SE2({kSide_m / kRowsPerSide, 0}, 0)));
    poses.push_back(poses.back() * lift(SE2({0, 0}, std::numbers::pi / 2)));
  }
  return poses;
}

/// A robot whose odometry drifts a little with every sample.
Mission drifting_mission(const std::vector<SE3>& truth, double yaw_drift_rad, int dimension) {
  std::vector<StampedPose<SE3>> rows{{Stamp{}, truth.front()}};
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const SE3 step = truth[k - 1].inverse() * truth[k] * lift(SE2({0, 0}, yaw_drift_rad));
    rows.push_back({Stamp::from_seconds(static_cast<double>(k)), rows.back().pose * step});
  }
  Mission mission;
  mission.dimension = dimension;
  mission.robots.resize(1);
  mission.robots[0].id = "a";
  mission.robots[0].odometry = Trajectory<SE3>(std::move(rows));
  mission.robots[0].odometry_noise.sigma_yaw_per_sqrt_m_rad = 0.01;
  return mission;
}

ScanClosure closure_between(const Mission& mission, const std::vector<SE3>& truth, std::size_t i,
                            std::size_t j) {
  ScanClosure closure;
  closure.robot = RobotIndex(0);
  closure.stamp_i = mission.robots[0].odometry[i].stamp;
  closure.stamp_j = mission.robots[0].odometry[j].stamp;
  closure.loop = {i, j, truth[i].inverse() * truth[j]};
  closure.loop.information.diagonal().setConstant(1 / (0.05 * 0.05));
  closure.loop.inlier_ratio = 0.7;
  return closure;
}

template <class Pose>
struct ClosedGraph {
  JointGraph<Pose> joint;
  std::vector<std::optional<std::size_t>> factors;  ///< of each closure
};

/// The mission with keyframes that the scans gave.
Mission scanned(Mission mission, const std::vector<ScanClosure>& scans, const KeyframeParams& params = {}) {
  std::vector<Stamp> given;
  for (const ScanClosure& closure : scans) given.insert(given.end(), {closure.stamp_i, closure.stamp_j});
  mission.robots[0].keyframes = choose_keyframes(mission, RobotIndex(0), params, given);
  return mission;
}

template <class Pose>
ClosedGraph<Pose> closed_graph(const Mission& mission, const std::vector<ScanClosure>& scans) {
  const auto closures = closures_of_scans(scans);
  ClosedGraph<Pose> closed{build_joint_graph<Pose>(scanned(mission, scans), {}, {}), {}};
  add_scan_closures(closed.joint, closures);
  closed.factors =
      factors_by_measurement(closed.joint.origins.relative_poses, FactorSource::kScanLoop, closures.size());
  return closed;
}

std::vector<ClosureResult> tested(const JointGraph<SE2>& joint, const std::vector<ScanClosure>& scans) {
  std::vector<Closure> closures;
  std::vector<ClosureJudgement> judgements;
  append(closures_of_scans(scans), closures, judgements);
  test_closures(joint, FactorSource::kScanLoop, judgements);
  return collect_closures(joint, closures, judgements);
}

double end_error_m(const Mission& mission, const std::vector<ScanClosure>& closures,
                   const std::vector<SE3>& truth) {
  const auto error_m = [&](const auto& poses) {
    return (poses.back().translation() - truth.back().translation().head(poses.back().translation().size()))
        .norm();
  };
  const auto solved = [](auto graph) {
    for (auto& factor : graph.relative_poses) factor.loss.kind = LossKind::kNone;  // the start is far
    optimize(graph, {});
    return graph.poses;
  };
  if (mission.dimension == 2) return error_m(solved(closed_graph<SE2>(mission, closures).joint.team.graph));
  return error_m(solved(closed_graph<SE3>(mission, closures).joint.team.graph));
}

TEST(AddScanClosures, DetermineTheTrajectory) {
  const auto truth = around_a_square();
  for (const int dimension : {2, 3}) {
    const Mission mission = drifting_mission(truth, 0.003, dimension);
    const std::vector<ScanClosure> closures{closure_between(mission, truth, 0, truth.size() - 1)};
    EXPECT_GT(end_error_m(mission, {}, truth), 2);
    EXPECT_LT(end_error_m(mission, closures, truth), 0.1);
  }
}

/// Keyframes that the scans' own loops moved to the truth take the poses between them along.
TEST(CorrectByScans, MovesPosesWithTheirKeyframes) {
  const auto truth = around_a_square();
  for (const bool is_known : {false, true}) {
    Mission mission = drifting_mission(truth, 0.003, 3);
    const SE3 start(Eigen::Vector3d(5, -3, 0),
                    Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ())));
    if (is_known) mission.robots[0].initial_pose = start;
    ScanOdometry scans;
    for (std::size_t k = 0; k < truth.size(); k += 3) {
      scans.keyframe_stamps.push_back(mission.robots[0].odometry[k].stamp);
      scans.corrected.push_back(lift(SE2({7, 7}, 2)) * truth[k]);  // in a frame of their own
    }
    auto joint = build_joint_graph<SE3>(mission, {}, {});
    correct_by_scans(joint, mission, {{scans}, {}, {}});
    const auto& poses = joint.team.graph.poses;
    const TrajectorySegment& segment = joint.team.segments[0];
    for (std::size_t n = 0; n < segment.pose_count; ++n) {
      const SE3 expected =
          (is_known ? start : SE3()) * truth[static_cast<std::size_t>(segment.stamps[n].seconds())];
      EXPECT_LT((poses[segment.first_pose + n].translation() - expected.translation()).norm(), 0.02) << n;
    }
  }
}

TEST(AddScanClosures, KeepATrajectoryWithoutClosures) {
  const auto truth = around_a_square();
  const Mission mission = drifting_mission(truth, 0.003, 2);
  const auto before = build_joint_graph<SE2>(mission, {}, {}).team.graph;
  const auto after = closed_graph<SE2>(mission, {}).joint.team.graph;
  ASSERT_EQ(before.poses.size(), after.poses.size());
  for (std::size_t k = 0; k < before.poses.size(); ++k)
    EXPECT_EQ((before.poses[k].inverse() * after.poses[k]).log().norm(), 0);
  EXPECT_EQ(before.relative_poses.size(), after.relative_poses.size());
}

TEST(AddScanClosures, OfRejectedLoopsAddNothing) {
  const auto truth = around_a_square();
  const Mission mission = drifting_mission(truth, 0.003, 2);
  auto rejected = closure_between(mission, truth, 0, truth.size() - 1);
  rejected.loop.status = LoopStatus::kAmbiguous;
  const auto closed = closed_graph<SE2>(mission, {rejected});
  ASSERT_EQ(closed.factors.size(), 1U);
  EXPECT_FALSE(closed.factors[0]);
  EXPECT_EQ(closed.joint.team.graph.relative_poses.size(),
            build_joint_graph<SE2>(mission, {}, {}).team.graph.relative_poses.size());
  const auto results = tested(closed.joint, {rejected});
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].kind, ClosureKind::kLidar);
  EXPECT_EQ(results[0].status, ClosureStatus::kRejected);
  EXPECT_EQ(results[0].reason, reason(LoopStatus::kAmbiguous));
}

/// At any sample: a scan that has a cloud is a keyframe.
TEST(AddScanClosures, ConnectTheirOwnStamps) {
  const auto truth = around_a_square();
  Mission mission = drifting_mission(truth, 0, 2);
  KeyframeParams sparse;
  sparse.distance_m = 7;
  sparse.angle_rad = 3;
  const std::vector<ScanClosure> scans{closure_between(mission, truth, 3, 81),
                                       closure_between(mission, truth, 5, 80)};
  const auto closures = closures_of_scans(scans);
  auto joint = build_joint_graph<SE2>(scanned(mission, scans, sparse), sparse, {});
  add_scan_closures(joint, closures);
  const auto factors =
      factors_by_measurement(joint.origins.relative_poses, FactorSource::kScanLoop, closures.size());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    ASSERT_TRUE(factors[k]);
    const auto& factor = joint.team.graph.relative_poses[*factors[k]];
    const auto pose = [&](PoseId id) { return joint.team.graph.poses[id.index()]; };
    EXPECT_LT((pose(factor.i).inverse() * flatten(truth[scans[k].loop.i])).log().norm(), 1e-3);
    EXPECT_LT((pose(factor.j).inverse() * flatten(truth[scans[k].loop.j])).log().norm(), 1e-3);
  }
}

/// Seen from above: the information on x, y and yaw with height, roll and pitch marginalised.
TEST(AddScanClosures, AreMarginalisedToThePlane) {
  const auto truth = around_a_square();
  const Mission mission = drifting_mission(truth, 0, 2);
  Rng rng(3);
  SE3::Jacobian root;
  for (double& value : root.reshaped()) value = rng.normal();
  auto closure = closure_between(mission, truth, 0, truth.size() - 1);
  closure.loop.information = 100 * (root * root.transpose() + SE3::Jacobian::Identity());
  const auto closed = closed_graph<SE2>(mission, {closure});
  const auto& factor = closed.joint.team.graph.relative_poses.at(closed.factors.at(0).value());
  const std::array<int, 3> plane{0, 1, 5};
  const SE3::Jacobian covariance = closure.loop.information.inverse();
  const Eigen::Matrix3d expected = Eigen::Matrix3d(covariance(plane, plane)).inverse();
  EXPECT_LT((factor.information - expected).norm(), 1e-6 * expected.norm());
}

TEST(TestClosures, AcceptWhatTheEstimateAgreesWith) {
  const auto truth = around_a_square();
  const Mission mission = drifting_mission(truth, 0.001, 2);
  std::vector<ScanClosure> closures{closure_between(mission, truth, 0, truth.size() - 1),
                                    closure_between(mission, truth, 1, truth.size() - 2),
                                    closure_between(mission, truth, 0, truth.size() - 3)};
  closures[1].loop.T_i_j = closures[1].loop.T_i_j * lift(SE2({3, 0}, 0.5));  // wrong, the only one
  auto closed = closed_graph<SE2>(mission, closures);
  closed.joint.team.graph.poses.clear();  // as the rest of the run would have found them
  for (const Stamp stamp : closed.joint.team.segments[0].stamps)
    closed.joint.team.graph.poses.push_back(
        flatten(truth[static_cast<std::size_t>(std::llround(stamp.seconds()))]));
  const auto results = tested(closed.joint, closures);
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[0].status, ClosureStatus::kAccepted);
  EXPECT_EQ(results[1].status, ClosureStatus::kRejected);
  EXPECT_FALSE(results[1].reason.empty());
  EXPECT_EQ(results[2].status, ClosureStatus::kAccepted);
  for (const ClosureResult& result : results) {
    EXPECT_EQ(result.robot_i, RobotIndex(0));
    EXPECT_EQ(result.robot_j, RobotIndex(0));
    EXPECT_LT(result.stamp_i, result.stamp_j);
    EXPECT_EQ(result.statistic > 11.345, result.status == ClosureStatus::kRejected);  // 99 % of chi-squared 3
  }
}

}  // namespace
}  // namespace radioslam
