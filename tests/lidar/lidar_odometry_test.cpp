#include "radioslam/lidar/lidar_odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "lidar/scan_drive.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/lidar/pose_search.hpp"

namespace radioslam {
namespace {

using namespace test;

Scanner scanner_of(ScannerKind kind) {
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
  if (kind == ScannerKind::kSpatial) scanner.azimuths = 150;
  return scanner;
}

void expect_end(const ScanPoses& poses, const ScanDrive& drive, double off_m, double off_rad) {
  ASSERT_EQ(poses.size(), drive.truth.size());
  EXPECT_LT(distance_between(poses.back().T_start_body, drive.way()), off_m);
  EXPECT_LT(angle_between(poses.back().T_start_body, drive.way()), off_rad);
}

constexpr double kClose_m = 0.03, kClose_rad = 0.3 * kDegree;

TEST(LidarOdometry, FollowsDrivesThroughRoomAndHall) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    const ScanDrive room = drive_along(furnished_room(), scanner_of(kind), around_furnished_room(40), 1);
    const ScanDrive hall = drive_along(furnished_hall(), scanner_of(kind), through_furnished_hall(40), 2);
    for (const ScanDrive* drive : {&room, &hall}) {
      const auto poses = odometry_of(*drive);
      expect_end(poses, *drive, kClose_m, kClose_rad);
      EXPECT_EQ(poses.front().status, ScanStatus::kMapStart);
      EXPECT_LT(poses.front().T_start_body.log().norm(), 1e-12);
      for (std::size_t k = 1; k < poses.size(); ++k) {
        EXPECT_EQ(poses[k].status, ScanStatus::kRegistered) << k;
        EXPECT_EQ(poses[k].stamp, drive->stamps[k]);
        EXPECT_FALSE(poses[k].cloud.all.empty());
      }
    }
  }
}

/// The stated sigmas of steps are at most twice too small and three times too large.
TEST(LidarOdometry, StatesTheErrorsOfItsSteps) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    const ScanDrive drive = drive_along(furnished_room(), scanner_of(kind), around_furnished_room(40), 3);
    const auto poses = odometry_of(drive);
    double nees = 0;
    for (std::size_t k = 1; k < poses.size(); ++k) {
      const SE3 step = poses[k - 1].T_start_body.inverse() * poses[k].T_start_body;
      const SE3::Tangent error = (step.inverse() * drive.truth[k - 1].inverse() * drive.truth[k]).log();
      nees += error.dot(poses[k].covariance.inverse() * error);
    }
    nees /= 6.0 * static_cast<double>(poses.size() - 1);
    EXPECT_LT(nees, 4);
    EXPECT_GT(nees, 0.1);
  }
}

/// An extra thirty degrees between every fifth scan and the next: to alternating sides, and always to one.
/// Averaged over several drives, because so few points of a room leave roll and pitch uncertain.
TEST(LidarOdometry, FollowsSuddenTurns) {
  constexpr int kDrives = 5;
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (const double other : {1.0, -1.0}) {
      auto poses = around_furnished_room(40);
      double turned = 0, off_m = 0, off_rad = 0;
      for (std::size_t k = 0; k < poses.size(); ++k) {
        if (k % 5 == 3) turned += 30 * kDegree * (k % 2 == 0 ? 1 : other);
        poses[k] = poses[k] * SE3::exp(planar_motion(0, 0, turned));
      }
      for (std::uint64_t seed = 4; seed < 4 + kDrives; ++seed) {
        const ScanDrive drive = drive_along(furnished_room(), scanner_of(kind), poses, seed);
        const SE3 end = odometry_of(drive).back().T_start_body;
        off_m += distance_between(end, drive.way()) / kDrives;
        off_rad += angle_between(end, drive.way()) / kDrives;
        EXPECT_LT(std::abs((end.inverse() * drive.way()).yaw()), 0.15 * kDegree) << seed;
      }
      EXPECT_LT(off_m, kClose_m);
      EXPECT_LT(off_rad, kClose_rad);
    }
}

/// Most points in a hall are scan lines on the floor around the scanner, which move along with it.
TEST(LidarOdometry, IsNotHeldByTheRingsOfItsBeams) {
  for (const std::uint64_t seed : {2U, 3U}) {
    auto poses = through_furnished_hall(40);
    for (std::size_t k = 0; k < poses.size(); ++k)
      poses[k] = poses[k] * SE3::exp(planar_motion(0, 0, 30 * kDegree * static_cast<double>((k + 1) / 4)));
    const ScanDrive drive = drive_along(furnished_hall(), scanner_of(ScannerKind::kSpatial), poses, seed);
    expect_end(odometry_of(drive), drive, kClose_m, kClose_rad);
  }
}

/// Neither the motion nor the nominal inlier ratio is known yet.
TEST(LidarOdometry, FollowsATurnBetweenItsFirstTwoScans) {
  std::vector<SE3> poses = around_furnished_room(40);
  poses.resize(3);  // 23 and 18 degrees apart
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (std::uint64_t seed = 5; seed <= 11; ++seed) {
      const ScanDrive drive = drive_along(furnished_room(), scanner_of(kind), poses, seed);
      expect_end(odometry_of(drive), drive, kClose_m, 2 * kClose_rad);
    }
}

/// A drive with corrupted scans inserted, and which of them are.
struct CorruptedDrive {
  ScanDrive drive;
  std::vector<bool> broken;
};

CorruptedDrive corrupted(const ScanDrive& drive, const std::vector<LidarScan>& broken) {
  CorruptedDrive result;
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

TEST(LidarOdometry, LeavesBrokenScansOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    Rng rng(5);
    const LidarScan all_nan{std::vector<Eigen::Vector3f>(3000, Eigen::Vector3f(nan, 1, 2)), {}};
    const LidarScan all_zero{std::vector<Eigen::Vector3f>(3000, Eigen::Vector3f::Zero()), {}};
    const LidarScan all_far{std::vector<Eigen::Vector3f>(3000, Eigen::Vector3f(481, 0, 0)), {}};
    const LidarScan three{{{1, 2, 0}, {3, 4, 0}, {-5, 1, 0}}, {}};
    const auto [drive, broken] =
        corrupted(drive_along(furnished_room(), scanner_of(kind), around_furnished_room(40), 6),
                  {{}, all_nan, three, noise_scan(kind, 1500, rng), all_zero, all_far});
    const auto poses = odometry_of(drive);
    for (std::size_t k = 0; k < poses.size(); ++k)
      EXPECT_EQ(is_tracked(poses[k].status), !broken[k]) << k << ", fits by " << poses[k].inlier_ratio;
    expect_end(poses, drive, kClose_m, kClose_rad);
  }
}

/// From the room into the hall, as by a lift: scans no longer match the map, but match each other.
TEST(LidarOdometry, BeginsANewMapWhereNothingFitsForLong) {
  constexpr std::size_t kInRoom = 10, kInHall = 20;
  const auto max_lost_scans = static_cast<std::size_t>(LidarOdometryParams().max_lost_scans);
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    ScanDrive drive = drive_along(furnished_room(), scanner_of(kind), around_furnished_room(40), 10);
    const ScanDrive hall = drive_along(furnished_hall(), scanner_of(kind), through_furnished_hall(40), 11);
    drive.truth.resize(kInRoom);
    drive.scans.resize(kInRoom);
    drive.truth.insert(drive.truth.end(), hall.truth.begin(), hall.truth.begin() + kInHall);
    drive.scans.insert(drive.scans.end(), hall.scans.begin(), hall.scans.begin() + kInHall);
    drive.stamps.resize(drive.scans.size());
    const auto poses = odometry_of(drive);
    const std::size_t begun = kInRoom + max_lost_scans;
    for (std::size_t k = 1; k < poses.size(); ++k)
      EXPECT_EQ(poses[k].status, k < kInRoom  ? ScanStatus::kRegistered
                                 : k < begun  ? ScanStatus::kLost
                                 : k == begun ? ScanStatus::kNewMap
                                              : ScanStatus::kRegistered)
          << k;
    // At most what a robot travels at constant velocity: 0.35 m per scan.
    const double on_m = distance_between(poses[begun].T_start_body, poses[kInRoom - 1].T_start_body);
    EXPECT_LT(on_m, 0.7 * static_cast<double>(max_lost_scans + 1));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(std::sqrt(poses[begun].covariance(axis, axis)), 0.5);
      EXPECT_GT(std::sqrt(poses[begun].covariance(axis + 3, axis + 3)), 10 * kDegree);
    }
    const SE3 expected = poses[begun].T_start_body * drive.truth[begun].inverse() * drive.truth.back();
    EXPECT_LT(distance_between(poses.back().T_start_body, expected), kClose_m);
    EXPECT_LT(angle_between(poses.back().T_start_body, expected), kClose_rad);
  }
}

/// Scans as delivered by a scanner that starts up or looks into the sun.
std::vector<LidarScan> garbage(ScannerKind kind, Rng& rng) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return {{},
          {std::vector<Eigen::Vector3f>(3000, Eigen::Vector3f(nan, 1, 2)), {}},
          {{{1, 2, 0}, {3, 4, 0}, {-5, 1, 0}}, {}},
          noise_scan(kind, 30, rng),
          noise_scan(kind, kind == ScannerKind::kPlanar ? 1500 : 8000, rng)};
}

/// Noise in the first scan, the second, or both does not stay the map.
void expect_no_harm(const ScanDrive& good, const std::vector<std::pair<std::size_t, LidarScan>>& broken) {
  ScanDrive drive = good;
  std::size_t first_good = 0;
  for (const auto& [place, scan] : broken) {
    drive.scans[place] = scan;
    if (place == first_good) ++first_good;
  }
  const auto poses = odometry_of(drive);
  EXPECT_EQ(poses[first_good].status, ScanStatus::kMapStart) << broken.front().second.points.size();
  for (std::size_t k = 2; k < poses.size(); ++k) {
    const SE3 motion = poses[first_good].T_start_body.inverse() * poses[k].T_start_body;
    const SE3 true_motion = drive.truth[first_good].inverse() * drive.truth[k];
    EXPECT_TRUE(is_tracked(poses[k].status)) << k;
    EXPECT_LT(distance_between(motion, true_motion), 2 * kClose_m) << k;
    EXPECT_LT(angle_between(motion, true_motion), 2 * kClose_rad) << k;
  }
}

TEST(LidarOdometry, DoesNotTakeNoiseForItsFirstMap) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    Rng rng(12);
    ScanDrive good = drive_along(furnished_room(), scanner_of(kind), around_furnished_room(60), 13);
    good.scans.resize(8);
    good.truth.resize(8);
    good.stamps.resize(8);
    for (const LidarScan& scan : garbage(kind, rng)) {
      expect_no_harm(good, {{0, scan}});
      expect_no_harm(good, {{1, scan}});
      expect_no_harm(good, {{0, scan}, {1, scan}});
      expect_no_harm(good, {{0, scan}, {1, noise_scan(kind, 1000, rng)}});
    }
  }
}

/// If no scan has structure, unstructured scans become the map after ten of them.
TEST(LidarOdometry, StartsWhereNothingHasOrder) {
  Rng rng(14);
  const LidarScan thicket = noise_scan(ScannerKind::kSpatial, 3000, rng);
  LidarOdometry odometer({0.3, ScannerKind::kSpatial}, {});
  const int max_lost_scans = LidarOdometryParams().max_lost_scans;
  for (int k = 0; k <= max_lost_scans + 3; ++k)
    EXPECT_EQ(odometer.register_scan({100'000'000 * k}, thicket).status,
              k < max_lost_scans    ? ScanStatus::kLost
              : k == max_lost_scans ? ScanStatus::kMapStart
                                    : ScanStatus::kRegistered)
        << k;
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

TEST(LidarOdometry, WaitsForAScanToStartFrom) {
  const ScanDrive drive =
      drive_along(furnished_room(), scanner_of(ScannerKind::kPlanar), around_furnished_room(40), 7);
  LidarOdometry odometer(scanner_traits(log_of(drive), {}), {});
  EXPECT_EQ(odometer.register_scan({-300}, {}).status, ScanStatus::kTooFewPoints);
  EXPECT_EQ(odometer.register_scan({-200}, {{{1, 2, 0}, {2, 1, 0}}, {}}).status, ScanStatus::kTooFewPoints);
  EXPECT_EQ(odometer.register_scan(drive.stamps[0], drive.scans[0]).status, ScanStatus::kMapStart);
  for (std::size_t k = 1; k < 5; ++k) {
    const ScanPose pose = odometer.register_scan(drive.stamps[k], drive.scans[k]);
    EXPECT_EQ(pose.status, ScanStatus::kRegistered);
    EXPECT_LT(distance_between(pose.T_start_body, drive.way_to(k)), kClose_m);
  }
}

TEST(LidarOdometry, AfterATimeWithoutScansGoesOnOnlyWhereItStood) {
  const ScanDrive drive =
      drive_along(furnished_room(), scanner_of(ScannerKind::kPlanar), around_furnished_room(40), 7);
  const auto elsewhere = drive.scans[20];  // metres away, as after an unrecorded motion
  struct Case {
    double gap_s;
    bool moved;
  };
  for (const auto [gap_s, moved] : {Case{2, false}, Case{2, true}, Case{600, false}}) {
    LidarOdometry odometer(scanner_traits(log_of(drive), {}), {});
    for (std::size_t k = 0; k < 5; ++k) odometer.register_scan(drive.stamps[k], drive.scans[k]);
    double time_s = drive.stamps[4].seconds();
    for (int k = 0; k < 60; ++k)  // it stands
      odometer.register_scan(Stamp::from_seconds(time_s += 0.1), drive.scans[4]);
    const Stamp later = Stamp::from_seconds(time_s + gap_s);
    const ScanPose pose = odometer.register_scan(later, moved ? elsewhere : drive.scans[4]);
    const bool may_be_elsewhere = moved || gap_s > 10;  // where it looks the same
    EXPECT_EQ(pose.status, may_be_elsewhere ? ScanStatus::kNewMap : ScanStatus::kRegistered);
    if (may_be_elsewhere)
      EXPECT_GT(pose.covariance.diagonal().minCoeff(), 0.2);
    else
      EXPECT_LT(distance_between(pose.T_start_body, drive.way_to(4)), kClose_m);
  }
}

/// The motion during a gap was measured otherwise: where that is too uncertain to choose among places that
/// look the same, a new map starts at its end, with its covariance.
TEST(LidarOdometry, AfterAGapWithAKnownMotionGoesOnFromItsEnd) {
  const ScanDrive drive =
      drive_along(furnished_room(), scanner_of(ScannerKind::kPlanar), around_furnished_room(40), 7);
  const SE3 motion = drive.truth[4].inverse() * drive.truth[8];
  const SE3 off = pose_at(0.05, -0.03, 0, 0.02);  // its error
  for (const double sigma_m : {0.05, 20.0}) {
    LidarOdometry odometer(scanner_traits(log_of(drive), {}), {});
    ScanPose last;
    for (std::size_t k = 0; k < 5; ++k) last = odometer.register_scan(drive.stamps[k], drive.scans[k]);
    SE3::Jacobian covariance = SE3::Jacobian::Identity() * 1e-4;
    covariance.diagonal().head<2>().setConstant(sigma_m * sigma_m);
    const double later_s = drive.stamps[4].seconds() + 30;
    const ScanPose pose = odometer.register_scan(Stamp::from_seconds(later_s), drive.scans[8], motion * off,
                                                 MotionSource::kOdometry, covariance);
    if (sigma_m < 1) {
      EXPECT_EQ(pose.status, ScanStatus::kRegistered);
      EXPECT_LT(distance_between(pose.T_start_body, drive.way_to(8)), kClose_m);
    } else {
      EXPECT_EQ(pose.status, ScanStatus::kNewMap);
      EXPECT_LT(distance_between(pose.T_start_body, last.T_start_body * motion * off), 1e-6);
      EXPECT_EQ(pose.covariance, covariance);
    }
    const ScanPose next = odometer.register_scan(Stamp::from_seconds(later_s + 0.1), drive.scans[9]);
    EXPECT_EQ(next.status, ScanStatus::kRegistered);
    EXPECT_LT(distance_between(pose.T_start_body.inverse() * next.T_start_body,
                               drive.truth[8].inverse() * drive.truth[9]),
              kClose_m);
  }
}

/// From rest to rest, rotating at up to 1.6 rad/s to one side and then to the other.
std::vector<SE3> turning_on_the_spot() {
  std::vector<SE3> poses;
  for (int k = 0; k <= 43; ++k) {
    const double fraction = std::min(1.0, k / 40.0);
    const double there = (1 - std::cos(std::numbers::pi * fraction)) / 2;
    const double there_and_back = 1 - std::cos(2 * std::numbers::pi * fraction);
    poses.push_back(pose_at(-1.5 + 3 * there, 0.15 * there_and_back, 1.2, there_and_back));
  }
  return poses;
}

double mean_angle_off(const ScanPoses& poses, const ScanDrive& drive) {
  double sum = 0;
  for (std::size_t k = 0; k < poses.size(); ++k)
    sum += angle_between(poses[k].T_start_body, drive.way_to(k)) / static_cast<double>(poses.size());
  return sum;
}

/// Stamps at the beginning of the sweeps are the hard case: velocity errors propagate to the next scan.
TEST(LidarOdometry, DeskewsScansTakenInMotion) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (const double stamp_at : {0.0, 1.0}) {
      Scanner scanner = scanner_of(kind);
      scanner.sweep_s = 0.1;
      scanner.stamp_at = stamp_at;
      ScanDrive drive = drive_along(furnished_room(), scanner, turning_on_the_spot(), 8);
      const auto deskewed = odometry_of(drive);
      expect_end(deskewed, drive, 0.05, kDegree);
      for (LidarScan& scan : drive.scans) scan.times_s.clear();
      const auto distorted = odometry_of(drive);
      EXPECT_LT(3 * mean_angle_off(deskewed, drive), mean_angle_off(distorted, drive));
    }
}

/// Half a metre from scan to scan.
std::vector<SE3> fast_straight_drive() {
  std::vector<SE3> poses;
  for (int k = 0; k < 12; ++k) poses.push_back(pose_at(-5 + 0.5 * k, 0.3, 1.2, 0));
  return poses;
}

Scanner sweeping(ScannerKind kind, double stamp_at) {
  Scanner scanner = scanner_of(kind);
  scanner.sweep_s = 0.1;
  scanner.stamp_at = stamp_at;
  return scanner;
}

void expect_path(const ScanPoses& found, const ScanDrive& drive, std::size_t from) {
  ASSERT_EQ(found.size(), drive.truth.size());
  for (std::size_t k = from; k < found.size(); ++k) {
    const SE3 motion = found[from].T_start_body.inverse() * found[k].T_start_body;
    EXPECT_LT(distance_between(motion, drive.truth[from].inverse() * drive.truth[k]), 0.05) << k;
  }
}

/// The velocity during the first sweep is unknown until the second scan is registered.
TEST(LidarOdometry, DeskewsItsFirstScanToo) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (const double stamp_at : {0.0, 0.5, 1.0}) {
      const ScanDrive drive =
          drive_along(furnished_hall(), sweeping(kind, stamp_at), fast_straight_drive(), 9);
      expect_path(odometry_of(drive), drive, 0);
    }
}

/// If the motion to the second scan is given, the first scan is deskewed by it.
TEST(LidarOdometry, DeskewsItsFirstScanByTheGivenMotion) {
  for (const double stamp_at : {0.0, 0.5, 1.0}) {
    const Scanner scanner = sweeping(ScannerKind::kPlanar, stamp_at);
    const ScanDrive drive = drive_along(furnished_hall(), scanner, fast_straight_drive(), 9);
    LidarOdometry odometer(scanner_traits(log_of(drive), {}), {});
    ScanPoses found;
    for (std::size_t k = 0; k < drive.scans.size(); ++k) {
      std::optional<SE3> motion;
      if (k > 0) motion = drive.truth[k - 1].inverse() * drive.truth[k];
      found.push_back(odometer.register_scan(drive.stamps[k], drive.scans[k], motion));
    }
    expect_path(found, drive, 0);
  }
}

/// The first scan of a map that starts after a gap was deskewed by the motion before the gap.
TEST(LidarOdometry, DeskewsTheFirstScanAfterAGap) {
  for (const double stamp_at : {0.0, 1.0}) {
    const Scanner scanner = sweeping(ScannerKind::kPlanar, stamp_at);
    ScanDrive drive = drive_along(furnished_hall(), scanner, fast_straight_drive(), 9);
    const std::size_t before = drive.truth.size();
    std::vector<SE3> elsewhere;
    for (int k = 0; k < 12; ++k) elsewhere.push_back(pose_at(9 - 0.5 * k, -1, 1.2, 3.0));
    const ScanDrive later = drive_along(furnished_hall(), scanner, elsewhere, 9);
    for (std::size_t k = 0; k < later.truth.size(); ++k) {
      drive.stamps.push_back({later.stamps[k].ns + Stamp::from_seconds(60).ns});
      drive.truth.push_back(later.truth[k]);
      drive.scans.push_back(later.scans[k]);
    }
    const auto found = odometry_of(drive);
    EXPECT_EQ(found[before].status, ScanStatus::kNewMap);
    expect_path(found, drive, before);
  }
}

/// The first scan is of another room: the next two form the map.
TEST(LidarOdometry, DeskewsTheFirstScansOfACandidateMap) {
  for (const double stamp_at : {0.0, 1.0}) {
    const Scanner scanner = sweeping(ScannerKind::kPlanar, stamp_at);
    ScanDrive drive = drive_along(furnished_hall(), scanner, fast_straight_drive(), 9);
    drive.scans[0] = drive_along(furnished_room(), scanner, around_furnished_room(40), 9).scans[0];
    const auto found = odometry_of(drive);
    EXPECT_EQ(found[1].status, ScanStatus::kLost);
    EXPECT_EQ(found[2].status, ScanStatus::kNewMap);
    expect_path(found, drive, 2);
  }
}

/// The first scan's cloud is returned again after deskewing.
TEST(LidarOdometry, ReturnsTheFirstCloudDeskewed) {
  const ScanDrive drive =
      drive_along(furnished_hall(), sweeping(ScannerKind::kPlanar, 0), fast_straight_drive(), 9);
  const auto found = odometry_of(drive);
  ASSERT_TRUE(found[1].first_cloud);
  for (std::size_t k = 2; k < found.size(); ++k) EXPECT_FALSE(found[k].first_cloud);
  const ScannerTraits traits = scanner_traits(log_of(drive), {});
  LocalMap map(traits.spacing_m, {});
  map.add(*found[1].first_cloud, SE3(), 0);
  for (std::size_t k = 2; k < 5; ++k) {
    const PosePrior prior{found[k].T_start_body, isotropic(1e-4, 1e-4)};
    const auto fit = register_near(map, found[k].cloud, prior, 0.3, traits.kind, {}, 0);
    EXPECT_LT(distance_between(fit.T_target_source, drive.way_to(k)), 0.03) << k;
  }
}

}  // namespace
}  // namespace radioslam
