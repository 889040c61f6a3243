#include "radioslam/team_frame/fingerprint_layout.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radio/fingerprints/walking_team.hpp"
#include "radioslam/geometry/alignment.hpp"

namespace radioslam {
namespace {

using test::WalkingTeam;

/// 120 of some 300 fingerprints give the same accuracy six times as fast.
TeamFrame align(const Mission& mission) {
  LayoutParams params;
  params.max_nodes = 120;
  return align_by_fingerprints(mission, known_starts(mission), measure_radio(mission, {}, {}), params, {});
}

/// Every tenth pose of the trajectories, true and by the team frame.
struct Places {
  Eigen::Matrix2Xd truth, estimate;
};

Places compare(const WalkingTeam& team, const TeamFrame& frame) {
  std::vector<Eigen::Vector2d> truth, estimate;
  for (std::size_t r = 0; r < team.walks.size(); ++r)
    for (std::size_t t = 0; t < team.walks[r].size(); t += 10) {
      truth.push_back(team.walks[r][t].translation());
      const SE2 T_start_body = flatten(team.mission.robots[r].odometry[t].pose);
      estimate.emplace_back((frame.T_team_start[r] * T_start_body).translation());
    }
  const auto n = static_cast<Eigen::Index>(truth.size());
  Places places{Eigen::Matrix2Xd(2, n), Eigen::Matrix2Xd(2, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    places.truth.col(i) = truth[static_cast<std::size_t>(i)];
    places.estimate.col(i) = estimate[static_cast<std::size_t>(i)];
  }
  return places;
}

double mean_error_m(const Places& places) { return (places.truth - places.estimate).colwise().norm().mean(); }

/// Mean error after one rigid alignment without mirroring.
double aligned_error_m(Places places) {
  const SE2 T_truth_estimate = align_points(places.estimate, places.truth);
  places.estimate = T_truth_estimate.rotation_matrix() * places.estimate;
  places.estimate.colwise() += T_truth_estimate.translation();
  return mean_error_m(places);
}

// Trajectories cover 60 m by 40 m: random alignment would be some 20 m off.
constexpr double kPlaced_m = 4;

TEST(AlignByFingerprints, PlacesATeamOfUnknownStarts) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto team = test::walking_team(4, Heading::kRelative, 150, seed);
    const auto frame = align(team.mission);
    EXPECT_LT(aligned_error_m(compare(team, frame)), kPlaced_m) << "seed " << seed;
    EXPECT_EQ(frame.component, std::vector<int>(4, 0));
    EXPECT_EQ(frame.placed, std::vector<bool>(4, true));
  }
}

TEST(AlignByFingerprints, ErrorsAreWithinThreeStatedSigmas) {
  constexpr double kNear_m = 3;  // what near fingerprints take back, and the walks' own errors
  int within = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto team = test::walking_team(4, Heading::kRelative, 150, seed);
    const auto frame = align(team.mission);
    Places places = compare(team, frame);
    const SE2 T = align_points(places.estimate, places.truth);
    Eigen::Index i = 0;
    for (std::size_t r = 0; r < team.walks.size(); ++r)
      for (std::size_t t = 0; t < team.walks[r].size(); t += 10, ++i, ++all)
        within += (T * Eigen::Vector2d(places.estimate.col(i)) - places.truth.col(i)).norm() <
                  3 * std::hypot(frame.sigma_layout_m[r], kNear_m);
  }
  EXPECT_GE(within, 0.95 * all);
}

SE2 mirror(const SE2& pose) {
  return {Eigen::Vector2d(pose.translation().x(), -pose.translation().y()), -pose.angle()};
}

/// The same radio on mirrored trajectories.
WalkingTeam mirror(WalkingTeam team) {
  for (std::size_t r = 0; r < team.walks.size(); ++r) {
    for (SE2& pose : team.walks[r]) pose = mirror(pose);
    Trajectory<SE3>& odometry = team.mission.robots[r].odometry;
    std::vector<StampedPose<SE3>> rows(odometry.begin(), odometry.end());
    for (auto& row : rows) row.pose = lift(mirror(flatten(row.pose)));
    odometry = Trajectory<SE3>(std::move(rows));
  }
  return team;
}

/// Similarities are invariant to mirroring; odometry distinguishes a layout from its mirror image.
TEST(AlignByFingerprints, DistinguishesALayoutFromItsMirrorImage) {
  for (std::uint64_t seed = 3; seed <= 6; ++seed) {
    // Short trajectories: on long ones a robot converges from the mirrored start too.
    const auto team = test::walking_team(4, Heading::kRelative, 60, seed);
    const auto mirrored = mirror(team);
    const double error_m = aligned_error_m(compare(team, align(team.mission)));
    EXPECT_LT(error_m, kPlaced_m) << "seed " << seed;
    EXPECT_NEAR(aligned_error_m(compare(mirrored, align(mirrored.mission))), error_m, 0.1) << "seed " << seed;
  }
}

TEST(AlignByFingerprints, KeepsTheCompassOfAbsoluteHeadings) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    auto team = test::walking_team(4, Heading::kAbsolute, 150, seed);
    for (Robot& robot : team.mission.robots) robot.sigma_heading_rad = 0.05;
    const auto frame = align(team.mission);
    auto places = compare(team, frame);
    places.truth.colwise() -= team.walks[0][0].translation();  // the first robot gives the origin
    EXPECT_LT(mean_error_m(places), kPlaced_m + 2) << "seed " << seed;
    for (const SE2& T_team_start : frame.T_team_start) EXPECT_NEAR(T_team_start.angle(), 0, 0.2);
  }
}

TEST(AlignByFingerprints, TheFirstRobotGivesTheFrame) {
  const auto team = test::walking_team(3, Heading::kRelative, 60, 1);
  const auto frame = align(team.mission);
  EXPECT_LT(frame.T_team_start[0].log().norm(), 1e-9);
  EXPECT_GT(frame.T_team_start[1].log().norm(), 0.1);
}

TEST(AlignByFingerprints, KeepsKnownStartsAndPlacesTheOthersAroundThem) {
  auto team = test::walking_team(4, Heading::kRelative, 150, 2);
  for (const std::size_t r : {1U, 3U}) team.mission.robots[r].initial_pose = lift(team.walks[r][0]);
  const auto frame = align(team.mission);
  for (const std::size_t r : {1U, 3U})
    EXPECT_LT((team.walks[r][0].inverse() * frame.T_team_start[r]).log().norm(), 1e-9);
  EXPECT_LT(mean_error_m(compare(team, frame)), kPlaced_m);
}

TEST(AlignByFingerprints, AnInitialPoseIsTheFirstBodysNotTheOdometrysOrigin) {
  auto team = test::walking_team(1, Heading::kRelative, 20, 3);
  Robot& robot = team.mission.robots[0];
  std::vector<StampedPose<SE3>> rows(robot.odometry.begin(), robot.odometry.end());
  for (auto& row : rows) row.pose = lift(SE2({7, -3}, 0.4)) * row.pose;
  robot.odometry = Trajectory<SE3>(std::move(rows));
  robot.initial_pose = lift(SE2({100, 50}, 1));
  const SE2 first = align(team.mission).T_team_start[0] * flatten(robot.odometry.front().pose);
  EXPECT_LT((first.inverse() * SE2({100, 50}, 1)).log().norm(), 1e-9);
}

TEST(AlignByFingerprints, TeamsWithoutACommonAccessPointAreApart) {
  WalkingTeam team;
  test::add_walkers(team, 2, Heading::kRelative, 100, Rng(1));
  test::add_walkers(team, 2, Heading::kRelative, 100, Rng(2));
  const auto frame = align(team.mission);
  EXPECT_EQ(frame.component, std::vector<int>({0, 0, 1, 1}));
  EXPECT_EQ(frame.placed, std::vector<bool>(4, true));
  EXPECT_LT(frame.T_team_start[2].log().norm(), 1e-9);  // the second group's frame is its first robot's
}

TEST(AlignByFingerprints, PlacesEachOfTwoTeams) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    WalkingTeam team;
    test::add_walkers(team, 3, Heading::kRelative, 120, Rng(seed));
    test::add_walkers(team, 3, Heading::kRelative, 120, Rng(seed + 100));
    const auto places = compare(team, align(team.mission));
    const Eigen::Index half = places.truth.cols() / 2;
    EXPECT_LT(aligned_error_m({places.truth.leftCols(half), places.estimate.leftCols(half)}), kPlaced_m)
        << seed;
    EXPECT_LT(aligned_error_m({places.truth.rightCols(half), places.estimate.rightCols(half)}), kPlaced_m)
        << seed;
  }
}

TEST(AlignByFingerprints, KnownStartsHoldTeamsTogether) {
  WalkingTeam team;
  test::add_walkers(team, 2, Heading::kRelative, 60, Rng(1));
  test::add_walkers(team, 2, Heading::kRelative, 60, Rng(2));
  for (const std::size_t r : {0U, 2U}) team.mission.robots[r].initial_pose = lift(team.walks[r][0]);
  EXPECT_EQ(align(team.mission).component, std::vector<int>(4, 0));
}

TEST(AlignByFingerprints, ARobotWithoutWifiIsUnplaced) {
  auto team = test::walking_team(3, Heading::kRelative, 60, 1);
  team.mission.robots[1].wifi.clear();
  const auto frame = align(team.mission);
  EXPECT_EQ(frame.component, std::vector<int>({0, 1, 0}));
  EXPECT_EQ(frame.placed, std::vector<bool>({true, false, true}));
}

TEST(AlignByFingerprints, ARobotWithoutWifiIsPlacedByItsInitialPose) {
  auto team = test::walking_team(3, Heading::kRelative, 60, 1);
  team.mission.robots[1].wifi.clear();
  for (const std::size_t r : {0U, 1U}) team.mission.robots[r].initial_pose = lift(team.walks[r][0]);
  const auto frame = align(team.mission);
  EXPECT_EQ(frame.component, std::vector<int>(3, 0));
  EXPECT_EQ(frame.placed, std::vector<bool>(3, true));
}

/// Keeps only the first `access_points` access points of every fingerprint.
Mission deafened(Mission mission, std::size_t access_points) {
  for (Robot& robot : mission.robots)
    for (WifiScan& scan : robot.wifi)
      std::erase_if(scan.readings,
                    [&](const WifiReading& r) { return r.access_point.index() >= access_points; });
  return mission;
}

TEST(AlignByFingerprints, TwoAccessPointsConnectNoRobots) {
  const auto team = test::walking_team(2, Heading::kRelative, 150, 1);
  EXPECT_EQ(align(deafened(team.mission, 2)).component, (std::vector<int>{0, 1}));
  EXPECT_EQ(align(deafened(team.mission, 6)).component, (std::vector<int>{0, 0}));
}

}  // namespace
}  // namespace radioslam
