// Radio links: measurements agree with the truth within the stated noise, and the labels are right.
#include "radioslam/sim/sensors/radio_channel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radioslam/geometry/so3.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Two robots on intersecting circles, one of them pitching, for 200 s.
std::vector<Trajectory<SE3>> circling_team() {
  std::vector<std::vector<StampedPose<SE3>>> poses(2);
  for (int k = 0; k <= 2000; ++k) {
    const double t_s = 0.1 * k;
    for (int r = 0; r < 2; ++r) {
      const double angle = (0.05 + 0.02 * r) * t_s;
      const Eigen::Vector3d place(40 * std::cos(angle) + 30 * r, 40 * std::sin(angle),
                                  3 * std::sin(angle + r));
      const auto rotation = so3_exp({0, 0, angle}) * so3_exp({0, 0.1 * std::sin(angle), 0});
      poses[static_cast<std::size_t>(r)].push_back({Stamp::from_seconds(t_s), {place, rotation}});
    }
  }
  return {Trajectory<SE3>(poses[0]), Trajectory<SE3>(poses[1])};
}

RadioChannelParams many_links() {
  RadioChannelParams params;
  params.links = 1500;
  return params;
}

RadioLinks simulate(const RadioChannelParams& params, int dimension = 3, std::uint64_t seed = 1) {
  return simulate_links(circling_team(), dimension, params, Rng(seed));
}

Eigen::Vector3d in_body(const std::vector<Trajectory<SE3>>& truth, const AoaMeasurement& aoa) {
  return truth[aoa.receiver.index()].at(aoa.stamp)->inverse() *
         truth[aoa.transmitter.robot.index()].at(aoa.stamp)->translation();
}

TEST(RadioChannel, RangesHaveTheStatedNoise) {
  const auto truth = circling_team();
  const auto links = simulate(many_links());
  ASSERT_GT(links.ranges.size(), 1000U);
  double sum = 0, squares = 0;
  for (const auto& range : links.ranges) {
    const double true_m = (truth[range.i.robot.index()].at(range.stamp)->translation() -
                           truth[range.j.robot.index()].at(range.stamp)->translation())
                              .norm();
    EXPECT_LE(true_m, 100);
    sum += (range.range_m - true_m) / range.sigma_m;
    squares += std::pow((range.range_m - true_m) / range.sigma_m, 2);
  }
  const auto n = static_cast<double>(links.ranges.size());
  EXPECT_NEAR(sum / n, 0, 4 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 4 * std::sqrt(2 / n));
}

TEST(RadioChannel, TheLabelledPathsPointToTheTransmitterWithTheStatedNoise) {
  const auto truth = circling_team();
  const auto links = simulate(many_links());
  double across = 0, up = 0, n = 0;
  for (std::size_t k = 0; k < links.aoa_measurements.size(); ++k) {
    if (*links.direct_paths[k] == kNoDirectPath) continue;
    const auto& path = links.aoa_measurements[k].paths[static_cast<std::size_t>(*links.direct_paths[k])];
    const Eigen::Vector3d way = in_body(truth, links.aoa_measurements[k]);
    const double azimuth = std::atan2(way.y(), way.x());
    const double elevation = std::asin(way.z() / way.norm());
    across += std::pow(wrap_angle(path.azimuth_rad - azimuth) * std::cos(elevation) / path.sigma_rad, 2);
    up += std::pow((*path.elevation_rad - elevation) / path.sigma_rad, 2);
    ++n;
  }
  EXPECT_NEAR(across / n, 1, 4 * std::sqrt(2 / n));
  EXPECT_NEAR(up / n, 1, 4 * std::sqrt(2 / n));
  EXPECT_NEAR(n / static_cast<double>(links.aoa_measurements.size()), 0.85, 0.03);
}

TEST(RadioChannel, FalsePathsAreAsManyAsAskedForAndComeFromAllAround) {
  RadioChannelParams params = many_links();
  params.missing_direct_ratio = 0;
  const auto links = simulate(params);
  double paths = 0, x = 0, y = 0, direct_is_first = 0;
  for (std::size_t k = 0; k < links.aoa_measurements.size(); ++k) {
    const auto& all = links.aoa_measurements[k].paths;
    EXPECT_GE(all.size(), 1U);
    EXPECT_LE(all.size(), 6U);
    for (std::size_t p = 0; p < all.size(); ++p) {
      EXPECT_LE(all[p].power_db, all[p > 0 ? p - 1 : 0].power_db);
      if (static_cast<int>(p) == *links.direct_paths[k]) continue;
      ++paths;
      x += std::cos(all[p].azimuth_rad);
      y += std::sin(all[p].azimuth_rad);
      EXPECT_LE(std::abs(*all[p].elevation_rad), 20 * kDegree);
    }
    if (*links.direct_paths[k] == 0) ++direct_is_first;
  }
  const auto n = static_cast<double>(links.aoa_measurements.size());
  EXPECT_NEAR(paths / n, 2.5, 0.15);
  EXPECT_NEAR(std::hypot(x, y) / paths, 0, 0.04);
  EXPECT_GT(direct_is_first / n, 0.6);  // stronger on average, but
  EXPECT_LT(direct_is_first / n, 0.9);  // the distributions overlap
}

TEST(RadioChannel, EveryAngleHasAMirrorImage) {
  RadioChannelParams params = many_links();
  params.mirror = true;
  params.max_false_paths = 0;
  params.missing_direct_ratio = 0;
  const auto truth = circling_team();
  const auto links = simulate(params);
  const MirrorWalls walls(truth[0], params, Rng(1).split(1).split(std::uint64_t{0}).split("walls"));
  double squares = 0;
  for (std::size_t k = 0; k < links.aoa_measurements.size(); ++k) {
    const auto& aoa = links.aoa_measurements[k];
    ASSERT_EQ(aoa.paths.size(), 2U);
    const auto& mirrored = aoa.paths[static_cast<std::size_t>(1 - *links.direct_paths[k])];
    const Eigen::Vector3d image =
        walls.at(aoa.stamp).image(truth[aoa.transmitter.robot.index()].at(aoa.stamp)->translation());
    const Eigen::Vector3d way = truth[aoa.receiver.index()].at(aoa.stamp)->inverse() * image;
    const double error = wrap_angle(mirrored.azimuth_rad - std::atan2(way.y(), way.x()));
    squares += std::pow(error * way.head<2>().norm() / way.norm() / mirrored.sigma_rad, 2);
  }
  EXPECT_NEAR(squares / static_cast<double>(links.aoa_measurements.size()), 1, 0.12);
}

TEST(RadioChannel, AWallShowsAnImageAsFarBehindItself) {
  const Wall wall{{0, 5, 0}, {0, 1, 0}};
  EXPECT_EQ(wall.image({1, 2, 3}), Eigen::Vector3d(1, 8, 3));
}

TEST(RadioChannel, MeasuresWhatIsEnabled) {
  RadioChannelParams params;
  EXPECT_EQ(simulate(params).ranges.size(), 40U);
  EXPECT_GT(simulate(params).aoa_measurements.size(), 70U);
  params.angle_ends = "one";
  const auto one = simulate(params);
  EXPECT_LE(one.aoa_measurements.size(), 40U);
  for (const auto& aoa : one.aoa_measurements) EXPECT_EQ(aoa.receiver, RobotIndex(0));
  params.angle_ends = "none";
  EXPECT_TRUE(simulate(params).aoa_measurements.empty());
  params.ranges = false;
  EXPECT_TRUE(simulate(params).ranges.empty());
  params.angle_ends = "both";
  for (const auto& aoa : simulate(params, 2).aoa_measurements)
    for (const auto& path : aoa.paths) EXPECT_FALSE(path.elevation_rad);
}

TEST(RadioChannel, AnglesComeLaterByTheOffset) {
  RadioChannelParams params;
  params.time_offset_s = 0.7;
  params.min_false_paths = 1;  // so that no measurement is empty
  const auto links = simulate(params);
  ASSERT_EQ(links.aoa_measurements.size(), 2 * links.ranges.size());
  for (std::size_t k = 0; k < links.ranges.size(); ++k)
    EXPECT_NEAR(seconds_between(links.ranges[k].stamp, links.aoa_measurements[2 * k].stamp), 0.7, 1e-12);
}

TEST(RadioChannel, LinksSpreadOverTheTimesInRange) {
  const auto truth = circling_team();
  const auto times = times_in_range(truth[0], truth[1], 60);
  RadioChannelParams params;
  params.radio_range_m = 60;
  params.links = 4;
  const auto links = simulate(params);
  ASSERT_EQ(links.ranges.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_GE(links.ranges[k].stamp, times[times.size() * k / 4]);
    EXPECT_LE(links.ranges[k].stamp, times[times.size() * (k + 1) / 4 - 1]);
  }
  params.radio_range_m = 1e-3;
  EXPECT_TRUE(simulate(params).ranges.empty());
}

}  // namespace
}  // namespace radioslam
