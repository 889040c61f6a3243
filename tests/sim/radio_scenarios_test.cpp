// city, hall and kitti: teams in contact, odometry that drifts as stated, and reproducible from the seed.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "radioslam/geometry/so3.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/sim/scenarios/scenarios.hpp"
#include "radioslam/sim/sensors/surface_odometry.hpp"
#include "radioslam/sim/worlds/hills.hpp"

namespace radioslam {
namespace {

bool same(const Simulation& a, const Simulation& b) {
  if (a.mission.robots.size() != b.mission.robots.size()) return false;
  for (std::size_t r = 0; r < a.mission.robots.size(); ++r) {
    const auto& x = a.mission.robots[r].odometry;
    const auto& y = b.mission.robots[r].odometry;
    if (x.size() != y.size() || x.back().pose.translation() != y.back().pose.translation()) return false;
  }
  const auto equal_ranges = [](const auto& x, const auto& y) {
    return x.stamp == y.stamp && x.range_m == y.range_m;
  };
  const auto equal_aoa = [](const auto& x, const auto& y) {
    return x.stamp == y.stamp && x.paths.size() == y.paths.size() &&
           x.paths[0].azimuth_rad == y.paths[0].azimuth_rad;
  };
  return std::equal(a.mission.ranges.begin(), a.mission.ranges.end(), b.mission.ranges.begin(),
                    b.mission.ranges.end(), equal_ranges) &&
         std::equal(a.mission.aoa_measurements.begin(), a.mission.aoa_measurements.end(),
                    b.mission.aoa_measurements.begin(), b.mission.aoa_measurements.end(), equal_aoa) &&
         a.truth.direct_paths == b.truth.direct_paths && a.truth.true_matches == b.truth.true_matches;
}

TEST(City, TeamsAreInContactAndTheirOdometryIsInItsOwnFrames) {
  CityParams params;
  params.robots = 3;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const auto [mission, truth] = simulate_city(params, seed);
    ASSERT_EQ(mission.robots.size(), 3U);
    EXPECT_GE(mission.ranges.size(), 80U);
    EXPECT_EQ(truth.direct_paths.size(), mission.aoa_measurements.size());
    for (std::size_t r = 0; r < 3; ++r) {
      const Robot& robot = mission.robots[r];
      EXPECT_FALSE(robot.initial_pose);
      EXPECT_EQ(robot.odometry.size(), truth.robots[r].poses.size());
      EXPECT_LT(robot.odometry.front().pose.log().norm(), 1e-12);
      EXPECT_NEAR(travelled_distance(truth.robots[r].poses).back(), 1700, 10);
      EXPECT_EQ(robot.odometry_noise.sigma_yaw_drift_per_m_rad, 0);
    }
  }
}

TEST(City, SameSeedSameMissionAndAnotherRobotChangesNothing) {
  CityParams params;
  params.path_length_m = 500;
  params.matches.matches_true = 10;
  EXPECT_TRUE(same(simulate_city(params, 7), simulate_city(params, 7)));
  EXPECT_FALSE(same(simulate_city(params, 7), simulate_city(params, 8)));
  const auto two = simulate_city(params, 7);
  params.robots = 3;
  const auto three = simulate_city(params, 7);
  EXPECT_EQ(two.mission.robots[1].odometry.back().pose.translation(),
            three.mission.robots[1].odometry.back().pose.translation());
  std::vector<double> ranges;
  for (const auto& range : three.mission.ranges)
    if (range.j.robot == RobotIndex(1)) ranges.push_back(range.range_m);
  ASSERT_EQ(ranges.size(), two.mission.ranges.size());
  for (std::size_t k = 0; k < ranges.size(); ++k) EXPECT_EQ(ranges[k], two.mission.ranges[k].range_m);
}

TEST(City, GoesOverHillsInThreeDimensions) {
  CityParams params;
  params.dimension = 3;
  params.path_length_m = 800;
  params.odometry.stated_noise_factor = 2;
  const auto [mission, truth] = simulate_city(params, 2);
  EXPECT_EQ(mission.dimension, 3);
  EXPECT_EQ(mission.robots[0].odometry_noise.sigma_z_per_sqrt_m, 0.02);
  double lowest = 1e9, highest = -1e9;
  for (const auto& [stamp, pose] : truth.robots[0].poses) {
    lowest = std::min(lowest, pose.translation().z());
    highest = std::max(highest, pose.translation().z());
  }
  EXPECT_GT(highest - lowest, 2);
  for (const auto& aoa : mission.aoa_measurements)
    for (const auto& path : aoa.paths) EXPECT_TRUE(path.elevation_rad);
}

TEST(City, ACompassGivesTheHeading) {
  CityParams params;
  params.path_length_m = 200;
  params.absolute_heading = true;
  params.sigma_heading_rad = 0.01;
  const auto [mission, truth] = simulate_city(params, 2);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(mission.robots[r].heading, Heading::kAbsolute);
    const double error =
        wrap_angle(mission.robots[r].odometry.front().pose.yaw() - truth.robots[r].poses.front().pose.yaw());
    EXPECT_LT(std::abs(error), 0.05);
  }
}

TEST(Hills, PosesAreUprightOnTheGround) {
  const Hills ground(5, Rng(2));
  const SE2 pose({40, -70}, 1.2);
  const SE3 body = ground.pose_on_ground(pose);
  EXPECT_NEAR(body.yaw(), 1.2, 1e-12);
  EXPECT_EQ(body.translation().z(), ground.height_m(pose.translation()));
  constexpr double kStep_m = 1e-4;
  for (const double direction :
       {0.0, 1.0, 2.0}) {  // every direction along the ground is at right angles to body z
    const Eigen::Vector2d step = kStep_m * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    const double rise =
        ground.height_m(pose.translation() + step) - ground.height_m(pose.translation() - step);
    const Eigen::Vector3d along(2 * step.x(), 2 * step.y(), rise);
    EXPECT_NEAR(along.normalized().dot(body.rotate(Eigen::Vector3d::UnitZ())), 0, 1e-7);
  }
  EXPECT_LT((Hills().pose_on_ground(pose).inverse() * lift(pose)).log().norm(), 1e-12);
}

TEST(SurfaceOdometry, WithoutNoiseIsTheTruthFromTheStart) {
  CityParams params;
  params.dimension = 3;
  params.path_length_m = 300;
  const auto truth = simulate_city(params, 2).truth.robots[0].poses;
  WheelOdometryParams exact = random_walk_odometry();
  exact.sigma_xy_per_sqrt_m = exact.sigma_yaw_per_sqrt_m_rad = exact.sigma_yaw_per_rad = 0;
  const auto odometry = drift_over_ground(truth, exact, 0, Rng(1));
  const SE3 start = lift(flatten(truth.front().pose), truth.front().pose.translation().z());
  for (std::size_t k = 0; k < truth.size(); ++k)
    EXPECT_LT((odometry[k].pose.inverse() * start.inverse() * truth[k].pose).log().norm(), 1e-9);
}

TEST(SurfaceOdometry, HeightIsARandomWalk) {
  CityParams params;
  params.path_length_m = 300;
  const auto truth = simulate_city(params, 2).truth.robots[0].poses;
  double squares = 0;
  constexpr int kWalks = 300;
  for (std::uint64_t seed = 0; seed < kWalks; ++seed)
    squares += std::pow(
        drift_over_ground(truth, random_walk_odometry(), 0.1, Rng(seed)).back().pose.translation().z(), 2);
  EXPECT_NEAR(squares / kWalks / (0.01 * travelled_distance(truth).back()), 1, 4 * std::sqrt(2.0 / kWalks));
}

TEST(Hall, IsSmallAndFullOfAliases) {
  const auto simulation = simulate_hall({}, 3);
  const auto& mission = simulation.mission;
  EXPECT_TRUE(same(simulation, simulate_hall({}, 3)));
  EXPECT_EQ(mission.matches.size(), 1848U);
  EXPECT_EQ(mission.ranges.size(), 4U);
  EXPECT_EQ(mission.aoa_measurements.size(), 4U);
  for (const auto& robot : simulation.truth.robots)
    for (const auto& [stamp, pose] : robot.poses) {
      EXPECT_GT(pose.translation().x(), 0);
      EXPECT_LT(pose.translation().x(), 25);
      EXPECT_LT(pose.translation().y(), 23);
    }
}

/// A drive along a figure of eight in an arbitrary frame, and slightly drifting odometry in another one.
RecordedDrive figure_of_eight() {
  std::vector<StampedPose<SE3>> truth, odometry;
  const SE3 elsewhere({3, 4, 5}, so3_exp({1, 0.5, -0.7}));
  for (int k = 0; k < 400; ++k) {
    const double s = 2 * std::numbers::pi * k / 400;
    const Eigen::Vector3d place(80 * std::sin(s), 40 * std::sin(2 * s), std::cos(s));
    const double yaw = std::atan2(80 * std::cos(2 * s), 80 * std::cos(s));
    const SE3 pose(place, so3_exp({0, 0, yaw}));
    truth.push_back({Stamp::from_seconds(0.1 * k), pose});
    odometry.push_back({Stamp::from_seconds(0.1 * k), elsewhere * pose * lift(SE2({1e-4 * k, 0}, 0))});
  }
  return {Trajectory<SE3>(std::move(truth)), Trajectory<SE3>(std::move(odometry))};
}

TEST(Kitti, CutsADriveInTwoThatStartTogether) {
  const RecordedDrive drive = figure_of_eight();
  KittiParams params;
  params.cut = 0.3;
  const auto [mission, truth] = simulate_kitti(params, drive, 1);
  ASSERT_EQ(mission.robots.size(), 2U);
  EXPECT_EQ(mission.robots[0].odometry.size(), 120U);
  EXPECT_EQ(mission.robots[1].odometry.size(), 280U);
  EXPECT_EQ(mission.robots[0].lidar_range_m, 17.5);
  EXPECT_GT(mission.ranges.size(), 0U);
  for (std::size_t r = 0; r < 2; ++r) {
    const auto& odometry = mission.robots[r].odometry;
    const auto& poses = truth.robots[r].poses;
    EXPECT_EQ(odometry.front().stamp, Stamp{});
    EXPECT_EQ(poses.front().stamp, Stamp{});
    EXPECT_LT(odometry.front().pose.log().norm(), 1e-9);
    const SE3 moved = poses.front().pose.inverse() * poses.back().pose;
    EXPECT_LT((moved.inverse() * odometry.back().pose).log().norm(), 0.1);
  }
  EXPECT_LT((drive.truth.front().pose.inverse() * drive.truth[120].pose).log().norm() -
                truth.robots[1].poses.front().pose.log().norm(),
            1e-9);
  EXPECT_TRUE(same(simulate_kitti(params, drive, 1), simulate_kitti(params, drive, 1)));
}

TEST(Kitti, IsProjectedToThePlane) {
  KittiParams params;
  params.dimension = 2;
  const auto [mission, truth] = simulate(ScenarioParams(params), 1, figure_of_eight());
  EXPECT_EQ(mission.dimension, 2);
  for (const auto& robot : truth.robots)
    for (const auto& [stamp, pose] : robot.poses) EXPECT_EQ(pose.translation().z(), 0);
  for (const auto& aoa : mission.aoa_measurements)
    for (const auto& path : aoa.paths) EXPECT_FALSE(path.elevation_rad);
}

/// One parameter at a time at an end of its range, unless that only makes the mission long.
template <class Params>
void run_at_the_ends(Params params, const std::set<std::string_view>& long_at_the_end) {
  Params::visit_fields(params, [&](const Field& field, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_arithmetic_v<Value>) {
      const Value before = value;
      for (const double end : {field.minimum, field.maximum}) {
        if (end == field.maximum && long_at_the_end.contains(field.name)) continue;
        value = static_cast<Value>(end);
        const auto [mission, truth] = simulate(ScenarioParams(params), 4, figure_of_eight());
        for (const auto& range : mission.ranges)
          ASSERT_TRUE(std::isfinite(range.range_m)) << field.name << " = " << end;
        for (const auto& aoa : mission.aoa_measurements)
          for (const auto& path : aoa.paths)
            ASSERT_TRUE(std::isfinite(path.azimuth_rad)) << field.name << " = " << end;
        for (const auto& robot : mission.robots) {
          ASSERT_TRUE(robot.odometry.empty() || robot.odometry.back().pose.translation().allFinite())
              << field.name << " = " << end;
          ASSERT_FALSE(robot.odometry.empty() && robot.lidar.empty()) << field.name << " = " << end;
          if (!robot.lidar.empty() && field.name != "lidar_azimuth_steps") robot.lidar.read(0);
        }
      }
      value = before;
    }
  });
}

const std::set<std::string_view> kLong{"robots",   "path_length_m", "odometry_rate_hz", "draws",
                                       "links",    "aliases",       "matches_true",     "matches_false",
                                       "blocks_x", "blocks_y"};

TEST(City, RunsAtTheEndsOfItsRanges) {
  CityParams params;
  params.path_length_m = 15;
  params.min_contact_s = 0;
  params.dimension = 3;
  params.matches = {2, 2};
  auto long_at_the_end = kLong;
  long_at_the_end.insert("least_meeting_s");
  run_at_the_ends(params, long_at_the_end);
}

TEST(Hall, RunsAtTheEndsOfItsRanges) {
  HallParams params;
  params.path_length_m = 6;
  params.matches = {2, 2};
  run_at_the_ends(params, kLong);
}

TEST(Corridors, RunAtTheEndsOfTheirRanges) {
  CorridorsParams params;
  params.path_length_m = 12;
  params.wheel_odometry = true;
  params.onboard.inertial.imu_hz = 20;
  params.onboard.lidar.lidar_azimuth_steps = 10;
  run_at_the_ends(params, kLong);
}

TEST(Kitti, RunsAtTheEndsOfItsRanges) {
  KittiParams params;
  params.radio.links = 3;
  run_at_the_ends(params, kLong);
  params.lidar.lidar_beams = 2;
  params.lidar.lidar_azimuth_steps = 10;
  run_at_the_ends(params, kLong);
}

}  // namespace
}  // namespace radioslam
