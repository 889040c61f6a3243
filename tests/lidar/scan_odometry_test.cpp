#include "radioslam/lidar/scan_odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lidar/scan_drive.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

using namespace test;

Scanner scanner_of(ScannerKind kind) {
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
  if (kind == ScannerKind::kSpatial) scanner.azimuths = 150;
  return scanner;
}

bool is_on_the_way(const ScanPose& pose) {
  return pose.outcome == ScanOutcome::kRegistered || pose.outcome == ScanOutcome::kFirst;
}

void expect_end(const std::vector<ScanPose>& poses, const ScanDrive& drive, double off_m, double off_rad) {
  ASSERT_EQ(poses.size(), drive.truth.size());
  EXPECT_LT(distance_between(poses.back().T_start_body, drive.way()), off_m);
  EXPECT_LT(angle_between(poses.back().T_start_body, drive.way()), off_rad);
}

constexpr double kClose_m = 0.03, kClose_rad = 0.3 * kDegree;

TEST(ScanOdometer, FollowsDrivesThroughRoomAndHall) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    const ScanDrive room = drive_along(furnished_room(), scanner_of(kind), around_furnished_room(40), 1);
    const ScanDrive hall = drive_along(furnished_hall(), scanner_of(kind), through_furnished_hall(40), 2);
    for (const ScanDrive* drive : {&room, &hall}) {
      const auto poses = odometry_of(*drive);
      expect_end(poses, *drive, kClose_m, kClose_rad);
      EXPECT_EQ(poses.front().outcome, ScanOutcome::kFirst);
      EXPECT_LT(poses.front().T_start_body.log().norm(), 1e-12);
      for (std::size_t k = 1; k < poses.size(); ++k) {
        EXPECT_EQ(poses[k].outcome, ScanOutcome::kRegistered) << k;
        EXPECT_EQ(poses[k].stamp, drive->stamps[k]);
        EXPECT_FALSE(poses[k].cloud.all.empty());
      }
    }
  }
}

TEST(ScanOdometer, IsNotSurerOfItsStepsThanTheyAreRight) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    const ScanDrive drive = drive_along(furnished_room(), scanner_of(kind), around_furnished_room(40), 3);
    const auto poses = odometry_of(drive);
    double nees = 0;
    for (std::size_t k = 1; k < poses.size(); ++k) {
      const SE3 step = poses[k - 1].T_start_body.inverse() * poses[k].T_start_body;
      const SE3::Tangent error = (step.inverse() * drive.truth[k - 1].inverse() * drive.truth[k]).log();
      nees += error.dot(poses[k].covariance.inverse() * error);
    }
    EXPECT_LT(nees / (6.0 * static_cast<double>(poses.size() - 1)), 1.5);
  }
}

/// Thirty degrees more, at once, between every fifth scan and the next: to either side, and always to one.
TEST(ScanOdometer, FollowsSuddenTurns) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (const double other : {1.0, -1.0}) {
      auto poses = around_furnished_room(40);
      double turned = 0;
      for (std::size_t k = 0; k < poses.size(); ++k) {
        if (k % 5 == 3) turned += 30 * kDegree * (k % 2 == 0 ? 1 : other);
        poses[k] = poses[k] * SE3::exp(planar_motion(0, 0, turned));
      }
      const ScanDrive drive = drive_along(furnished_room(), scanner_of(kind), poses, 4);
      expect_end(odometry_of(drive), drive, kClose_m, kClose_rad);
    }
}

/// Most of a hall's points lie on rings about the scanner, on the floor: they turn and move along with it.
TEST(ScanOdometer, IsNotHeldByTheRingsOfItsBeams) {
  for (const std::uint64_t seed : {2U, 3U}) {
    auto poses = through_furnished_hall(40);
    for (std::size_t k = 0; k < poses.size(); ++k)
      poses[k] = poses[k] * SE3::exp(planar_motion(0, 0, 30 * kDegree * static_cast<double>((k + 1) / 4)));
    const ScanDrive drive = drive_along(furnished_hall(), scanner_of(ScannerKind::kSpatial), poses, seed);
    expect_end(odometry_of(drive), drive, kClose_m, kClose_rad);
  }
}

/// Nothing is known of the motion and of the usual fit yet.
TEST(ScanOdometer, FollowsATurnBetweenItsFirstTwoScans) {
  std::vector<SE3> poses = around_furnished_room(40);
  poses.resize(3);  // 23 and 18 degrees apart
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (std::uint64_t seed = 5; seed <= 11; ++seed) {
      const ScanDrive drive = drive_along(furnished_room(), scanner_of(kind), poses, seed);
      expect_end(odometry_of(drive), drive, kClose_m, 2 * kClose_rad);
    }
}

LidarScan noise_scan(ScannerKind kind, int count, Rng& rng) {
  LidarScan scan;
  for (int k = 0; k < count; ++k) {
    const double x = rng.uniform(-8, 8), y = rng.uniform(-8, 8), z = rng.uniform(-2, 3);
    scan.points.emplace_back(Eigen::Vector3d(x, y, kind == ScannerKind::kPlanar ? 0 : z).cast<float>());
  }
  return scan;
}

/// The drive with broken scans among its scans, and which of them are.
struct SpoiltDrive {
  ScanDrive drive;
  std::vector<bool> broken;
};

SpoiltDrive spoilt(const ScanDrive& drive, const std::vector<LidarScan>& broken) {
  SpoiltDrive result;
  const auto add = [&](Stamp stamp, const SE3& truth, const LidarScan& scan, bool is_broken) {
    result.drive.stamps.push_back(stamp);
    result.drive.truth.push_back(truth);
    result.drive.scans.push_back(scan);
    result.broken.push_back(is_broken);
  };
  for (std::size_t k = 0; k < drive.scans.size(); ++k) {
    add(drive.stamps[k], drive.truth[k], drive.scans[k], false);
    if (k < 4 || k % 2 == 1) continue;
    add({drive.stamps[k].ns + 50'000'000}, drive.truth[k], broken[k / 2 % broken.size()], true);
  }
  return result;
}

TEST(ScanOdometer, LeavesBrokenScansOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    Rng rng(5);
    const LidarScan all_nan{std::vector<Eigen::Vector3f>(3000, Eigen::Vector3f(nan, 1, 2)), {}};
    const LidarScan all_zero{std::vector<Eigen::Vector3f>(3000, Eigen::Vector3f::Zero()), {}};
    const LidarScan all_far{std::vector<Eigen::Vector3f>(3000, Eigen::Vector3f(481, 0, 0)), {}};
    const LidarScan three{{{1, 2, 0}, {3, 4, 0}, {-5, 1, 0}}, {}};
    const auto [drive, broken] =
        spoilt(drive_along(furnished_room(), scanner_of(kind), around_furnished_room(40), 6),
               {{}, all_nan, three, noise_scan(kind, 1500, rng), all_zero, all_far});
    const auto poses = odometry_of(drive);
    for (std::size_t k = 0; k < poses.size(); ++k)
      EXPECT_EQ(is_on_the_way(poses[k]), !broken[k]) << k << ", fits by " << poses[k].matched_share;
    expect_end(poses, drive, kClose_m, kClose_rad);
  }
}

/// Where all scans fit worse than they used to, the map is to blame.
TEST(ScanOdometer, GoesOnAfterScansThatItMissed) {
  ScanDrive drive =
      drive_along(furnished_hall(), scanner_of(ScannerKind::kPlanar), through_furnished_hall(60), 10);
  drive.truth.erase(drive.truth.begin() + 12, drive.truth.begin() + 40);
  drive.scans.erase(drive.scans.begin() + 12, drive.scans.begin() + 40);
  drive.stamps.resize(drive.scans.size());
  LidarParams params;
  params.odometry.least_matched_share = 0;
  params.odometry.least_usual_share = 1;
  params.odometry.patience = 5;
  const auto poses = odometry_of(drive, params);
  std::size_t left_out = 0, longest = 0;
  for (const ScanPose& pose : poses) {
    left_out = is_on_the_way(pose) ? 0 : left_out + 1;
    longest = std::max(longest, left_out);
  }
  EXPECT_EQ(longest, 5U);
}

TEST(ScannerTraits, AreTheScannersAndTheRooms) {
  const auto traits_of = [](const ScannedRoom& room, ScannerKind kind, double spacing_m) {
    LidarParams params;
    params.odometry.spacing_m = spacing_m;
    return scanner_traits(log_of(drive_along(room, scanner_of(kind), around_furnished_room(5), 9)), params);
  };
  EXPECT_EQ(traits_of(furnished_room(), ScannerKind::kPlanar, 0).kind, ScannerKind::kPlanar);
  const ScannerTraits room = traits_of(furnished_room(), ScannerKind::kSpatial, 0);
  const ScannerTraits hall = traits_of(furnished_hall(), ScannerKind::kSpatial, 0);
  EXPECT_EQ(room.kind, ScannerKind::kSpatial);
  EXPECT_LT(room.spacing_m, hall.spacing_m);
  EXPECT_EQ(traits_of(furnished_hall(), ScannerKind::kPlanar, 0.123).spacing_m, 0.123);
}

TEST(ScannerTraits, ComeFromAtMostTenScans) {
  for (const std::size_t size : {0U, 1U, 9U, 10U, 11U, 19U, 20U, 995U}) {
    std::size_t reads = 0;
    LidarLog log;
    for (std::size_t k = 0; k < size; ++k) log.stamps.push_back({static_cast<std::int64_t>(k)});
    log.read = [&](std::size_t k) {
      EXPECT_LT(k, size);
      ++reads;
      return LidarScan{};
    };
    EXPECT_GT(scanner_traits(log, {}).spacing_m, 0);
    EXPECT_LE(reads, 10U) << size;
    EXPECT_EQ(reads > 0, size > 0);
  }
}

TEST(ScanOdometer, WaitsForAScanToStartFrom) {
  const ScanDrive drive =
      drive_along(furnished_room(), scanner_of(ScannerKind::kPlanar), around_furnished_room(40), 7);
  ScanOdometer odometer(scanner_traits(log_of(drive), {}), {});
  EXPECT_EQ(odometer.add({-300}, {}).outcome, ScanOutcome::kTooFew);
  EXPECT_EQ(odometer.add({-200}, {{{1, 2, 0}, {2, 1, 0}}, {}}).outcome, ScanOutcome::kTooFew);
  EXPECT_EQ(odometer.add(drive.stamps[0], drive.scans[0]).outcome, ScanOutcome::kFirst);
  for (std::size_t k = 1; k < 5; ++k) {
    const ScanPose pose = odometer.add(drive.stamps[k], drive.scans[k]);
    EXPECT_EQ(pose.outcome, ScanOutcome::kRegistered);
    EXPECT_LT(distance_between(pose.T_start_body, drive.way_to(k)), kClose_m);
  }
}

/// From rest, turning as fast as 1.6 rad/s to one side and then to the other, and at rest again.
std::vector<SE3> turning_on_the_spot() {
  std::vector<SE3> poses;
  for (int k = 0; k <= 43; ++k) {
    const double share = std::min(1.0, k / 40.0);
    const double way = (1 - std::cos(std::numbers::pi * share)) / 2;
    const double there_and_back = 1 - std::cos(2 * std::numbers::pi * share);
    poses.push_back(pose_at(-1.5 + 3 * way, 0.15 * there_and_back, 1.2, there_and_back));
  }
  return poses;
}

double mean_angle_off(const std::vector<ScanPose>& poses, const ScanDrive& drive) {
  double sum = 0;
  for (std::size_t k = 0; k < poses.size(); ++k)
    sum += angle_between(poses[k].T_start_body, drive.way_to(k)) / static_cast<double>(poses.size());
  return sum;
}

/// Stamps at the beginning of the sweeps are the hard case: an error of the motion returns as the next one's.
TEST(ScanOdometer, UnbendsScansThatWereSweptOnTheMove) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (const double stamp_at : {0.0, 1.0}) {
      Scanner scanner = scanner_of(kind);
      scanner.sweep_s = 0.1;
      scanner.stamp_at = stamp_at;
      ScanDrive drive = drive_along(furnished_room(), scanner, turning_on_the_spot(), 8);
      const auto unbent = odometry_of(drive);
      expect_end(unbent, drive, 0.05, kDegree);
      for (LidarScan& scan : drive.scans) scan.times_s.clear();
      const auto bent = odometry_of(drive);
      EXPECT_LT(3 * mean_angle_off(unbent, drive), mean_angle_off(bent, drive));
    }
}

}  // namespace
}  // namespace radioslam
