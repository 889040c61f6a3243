// Scans of a moving robot: every point is on a surface once it is transformed by the pose at its own time.
#include "radioslam/sim/sensors/lidar_scanner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr double kScanDegree = std::numbers::pi / 180;

/// A room of 12 x 8 x 3 m around the origin with a pillar in it.
std::shared_ptr<const RayWorld> pillar_room() {
  WorldShapes shapes;
  shapes.boxes.push_back({{0, 0}, {1, 0}, {6, 4}, 0, 3});
  shapes.pillars.push_back({{2, 1}, 0.4, 0, 3});
  return std::make_shared<const RayWorld>(shapes);
}

double distance_to_room_m(const Eigen::Vector3d& p) {
  const double walls = std::min(
      {std::abs(6 - std::abs(p.x())), std::abs(4 - std::abs(p.y())), std::abs(p.z()), std::abs(3 - p.z())});
  return std::min(walls, std::abs(std::hypot(p.x() - 2, p.y() - 1) - 0.4));
}

/// Fast, turning and tilted.
std::shared_ptr<const TrueMotion> hasty_motion() {
  std::vector<SE3> controls;
  for (int k = 0; k < 14; ++k)
    controls.emplace_back(Eigen::Vector3d(-3 + 0.25 * k, -1 - 0.1 * std::sin(1.0 * k), 0.1 * (k % 2)),
                          so3_exp({0.05 * std::sin(2.0 * k), 0.04, 0.2 * k}));
  return std::make_shared<const TrueMotion>(SplineMotion(controls, 0.1));
}

std::shared_ptr<const TrueMotion> standing_still(const SE3& pose) {
  return std::make_shared<const TrueMotion>(SplineMotion(std::vector<SE3>(23, pose), 1));
}

LidarScannerParams scanner_of(int beams) {
  LidarScannerParams params;
  params.lidar_beams = beams;
  params.range_m = 30;
  return params;
}

TEST(LidarScanner, BeamsSpreadAsPublished) {
  const auto sixteen = beam_elevations_rad(scanner_of(16)), sixty_four = beam_elevations_rad(scanner_of(64));
  ASSERT_EQ(sixteen.size(), 16U);
  for (std::size_t k = 0; k < 16; ++k)
    EXPECT_NEAR(sixteen[k] / kScanDegree, -15 + 2.0 * static_cast<double>(k), 1e-9);
  ASSERT_EQ(sixty_four.size(), 64U);
  EXPECT_NEAR(sixty_four.front() / kScanDegree, -24.8, 1e-9);
  EXPECT_NEAR(sixty_four.back() / kScanDegree, 2, 1e-9);
  EXPECT_EQ(beam_elevations_rad(scanner_of(1)), std::vector<double>{0});
  LidarScannerParams own = scanner_of(3);
  own.lidar_lowest_deg = -10;
  own.lidar_highest_deg = 30;
  EXPECT_NEAR(beam_elevations_rad(own)[1] / kScanDegree, 10, 1e-9);
}

TEST(LidarScanner, PointsOfAMovingScanLieOnTheSurfacesAtTheirOwnTimes) {
  const auto motion = hasty_motion();
  LidarScannerParams params = scanner_of(16);
  params.lidar_sigma_m = 0.02;
  const LidarLog log = scan_along(pillar_room(), motion, params, Rng(1));
  ASSERT_EQ(log.size(), 11U);
  double at_the_stamp_m = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const LidarScan scan = log.read(k);
    ASSERT_EQ(scan.points.size(), 16U * 900U) << "a closed room";
    ASSERT_EQ(scan.times_s.size(), scan.points.size());
    std::size_t beyond = 0;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Eigen::Vector3d point = scan.points[i].cast<double>();
      const Stamp own{log.stamps[k].ns + Stamp::from_seconds(static_cast<double>(scan.times_s[i])).ns};
      const double off_m = distance_to_room_m(motion->pose_at(own) * point);
      if (off_m > 4 * params.lidar_sigma_m) ++beyond;
      EXPECT_LT(off_m, 6 * params.lidar_sigma_m);
      at_the_stamp_m = std::max(at_the_stamp_m, distance_to_room_m(motion->pose_at(log.stamps[k]) * point));
    }
    EXPECT_LE(beyond, 8U) << "6e-5 of 14,400 are beyond 4 sigma";
    EXPECT_TRUE(std::is_sorted(scan.times_s.begin(), scan.times_s.end()));
    EXPECT_GE(scan.times_s.front(), 0.0F);
    EXPECT_LT(scan.times_s.back(), 0.1F);
  }
  EXPECT_GT(at_the_stamp_m, 0.3) << "raw: the motion distortion is left in";
}

TEST(LidarScanner, AtRestItMeasuresWhatGeometryGives) {
  LidarScannerParams params = scanner_of(1);
  params.lidar_azimuth_steps = 4;  // at -135, -45, 45 and 135 degrees
  params.lidar_sigma_m = 0;
  const LidarScan scan =
      sweep(*pillar_room(), *standing_still(lift(SE2({-2, 0}, 0))), params, Stamp{}, Rng(1));
  ASSERT_EQ(scan.points.size(), 4U);
  const double height = params.lidar_height_m;
  const std::vector<Eigen::Vector3d> expected{
      {-4, -4, height}, {4, -4, height}, {4, 4, height}, {-4, 4, height}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((scan.points[i].cast<double>() - expected[i]).norm(), 1e-5) << i;
    EXPECT_NEAR(scan.times_s[i], 0.1 * (static_cast<double>(i) + 0.5) / 4, 1e-8);
  }
}

TEST(LidarScanner, ItsNoiseIsAlongTheBeamAndAsStated) {
  LidarScannerParams params = scanner_of(1);
  params.lidar_sigma_m = 0.05;
  const auto room = pillar_room();
  const auto motion = standing_still(lift(SE2({-3, 0}, 0)));
  double sum = 0, squares = 0;
  int count = 0;
  LidarScannerParams exact = params;
  exact.lidar_sigma_m = 0;
  const LidarScan truth = sweep(*room, *motion, exact, Stamp{}, Rng(1));
  for (std::uint64_t k = 0; k < 20; ++k) {
    const LidarScan scan = sweep(*room, *motion, params, Stamp{}, Rng(7).split(k));
    ASSERT_EQ(scan.points.size(), truth.points.size());
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Eigen::Vector3d up(0, 0, params.lidar_height_m);
      const Eigen::Vector3d beam = truth.points[i].cast<double>() - up;
      const Eigen::Vector3d off = (scan.points[i] - truth.points[i]).cast<double>();
      EXPECT_LT(off.cross(beam.normalized()).norm(), 1e-5);
      const double along_m = off.dot(beam.normalized());
      sum += along_m;
      squares += along_m * along_m;
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 0, 4 * 0.05 / std::sqrt(count));
  EXPECT_NEAR(squares / count / (0.05 * 0.05), 1, 4 * std::sqrt(2.0 / count));
}

TEST(LidarScanner, LeavesOutWhatIsTooNearTooFarOrLost) {
  const auto room = pillar_room();
  const auto motion = standing_still(lift(SE2({-5, 0}, 0)));
  LidarScannerParams params = scanner_of(1);
  params.lidar_min_range_m = 2;
  params.range_m = 8;
  const LidarScan scan = sweep(*room, *motion, params, Stamp{}, Rng(1));
  EXPECT_LT(scan.points.size(), 900U);
  for (const auto& point : scan.points) {
    EXPECT_GE(point.head<2>().norm(), 1.999F);
    EXPECT_LE(point.head<2>().norm(), 8.001F);
  }
  LidarScannerParams lossy = scanner_of(16);
  lossy.lidar_dropout_ratio = 0.2;
  const double left = static_cast<double>(sweep(*room, *motion, lossy, Stamp{}, Rng(1)).points.size());
  EXPECT_NEAR(left / (16 * 900), 0.8, 4 * std::sqrt(0.16 / (16 * 900)));
}

TEST(LidarScanner, APlanarScannerLooksAhead) {
  LidarScannerParams params = scanner_of(1);
  params.lidar_view_deg = 180;
  params.lidar_azimuth_steps = 180;
  params.lidar_sigma_m = 0;
  const LidarScan scan = sweep(*pillar_room(), *standing_still(SE3()), params, Stamp{}, Rng(1));
  ASSERT_EQ(scan.points.size(), 180U);
  for (std::size_t i = 0; i < 180; ++i) {
    const Eigen::Vector3d point = scan.points[i].cast<double>();
    EXPECT_NEAR(std::atan2(point.y(), point.x()) / kScanDegree, -89.5 + static_cast<double>(i), 1e-3);
    EXPECT_NEAR(point.z(), params.lidar_height_m, 1e-6);
    EXPECT_NEAR(scan.times_s[i], 0.025 + 0.05 * (static_cast<double>(i) + 0.5) / 180, 1e-7);
  }
}

TEST(LidarScanner, ReadsTheSameInAnyOrderAndByAnyThread) {
  const LidarLog log = scan_along(pillar_room(), hasty_motion(), scanner_of(16), Rng(1));
  std::vector<LidarScan> backwards(log.size()), at_once(log.size());
  for (std::size_t k = log.size(); k-- > 0;) backwards[k] = log.read(k);
  set_thread_count(4);
  parallel_for(log.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) at_once[k] = log.read(k);
  });
  set_thread_count(0);
  for (std::size_t k = 0; k < log.size(); ++k) {
    EXPECT_EQ(backwards[k].points, at_once[k].points);
    EXPECT_EQ(backwards[k].times_s, at_once[k].times_s);
  }
  EXPECT_NE(backwards[0].points, backwards[1].points);
}

}  // namespace
}  // namespace radioslam
