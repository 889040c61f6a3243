#include "radioslam/lidar/scan_odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

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
/// On average over some drives: what is left is how far so few points of a room let a robot lean.
TEST(ScanOdometer, FollowsSuddenTurns) {
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
      EXPECT_EQ(is_on_the_way(poses[k].outcome), !broken[k]) << k << ", fits by " << poses[k].matched_share;
    expect_end(poses, drive, kClose_m, kClose_rad);
  }
}

/// From the room into the hall, as by a lift: nothing fits any more, but what comes fits together.
TEST(ScanOdometer, BeginsANewMapWhereNothingFitsForLong) {
  constexpr std::size_t kInRoom = 10, kInHall = 20;
  const auto patience = static_cast<std::size_t>(ScanOdometryParams().patience);
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    ScanDrive drive = drive_along(furnished_room(), scanner_of(kind), around_furnished_room(40), 10);
    const ScanDrive hall = drive_along(furnished_hall(), scanner_of(kind), through_furnished_hall(40), 11);
    drive.truth.resize(kInRoom);
    drive.scans.resize(kInRoom);
    drive.truth.insert(drive.truth.end(), hall.truth.begin(), hall.truth.begin() + kInHall);
    drive.scans.insert(drive.scans.end(), hall.scans.begin(), hall.scans.begin() + kInHall);
    drive.stamps.resize(drive.scans.size());
    const auto poses = odometry_of(drive);
    const std::size_t begun = kInRoom + patience;
    for (std::size_t k = 1; k < poses.size(); ++k)
      EXPECT_EQ(poses[k].outcome, k < kInRoom  ? ScanOutcome::kRegistered
                                  : k < begun  ? ScanOutcome::kUnmatched
                                  : k == begun ? ScanOutcome::kNewMap
                                               : ScanOutcome::kRegistered)
          << k;
    // No more than a robot may go that drives on as before: 0.35 m from one scan to the next.
    const double on_m = distance_between(poses[begun].T_start_body, poses[kInRoom - 1].T_start_body);
    EXPECT_LT(on_m, 0.7 * static_cast<double>(patience + 1));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(std::sqrt(poses[begun].covariance(axis, axis)), 0.5);
      EXPECT_GT(std::sqrt(poses[begun].covariance(axis + 3, axis + 3)), 10 * kDegree);
    }
    const SE3 expected = poses[begun].T_start_body * drive.truth[begun].inverse() * drive.truth.back();
    EXPECT_LT(distance_between(poses.back().T_start_body, expected), kClose_m);
    EXPECT_LT(angle_between(poses.back().T_start_body, expected), kClose_rad);
  }
}

/// What scanners deliver that start, or that look into the sun.
std::vector<LidarScan> garbage(ScannerKind kind, Rng& rng) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return {{},
          {std::vector<Eigen::Vector3f>(3000, Eigen::Vector3f(nan, 1, 2)), {}},
          {{{1, 2, 0}, {3, 4, 0}, {-5, 1, 0}}, {}},
          noise_scan(kind, 30, rng),
          noise_scan(kind, kind == ScannerKind::kPlanar ? 1500 : 8000, rng)};
}

/// It is no map for good, be it the first scan, the second, or both.
void expect_no_harm(const ScanDrive& good, const std::vector<std::pair<std::size_t, LidarScan>>& broken) {
  ScanDrive drive = good;
  std::size_t first_good = 0;
  for (const auto& [place, scan] : broken) {
    drive.scans[place] = scan;
    if (place == first_good) ++first_good;
  }
  const auto poses = odometry_of(drive);
  EXPECT_EQ(poses[first_good].outcome, ScanOutcome::kFirst) << broken.front().second.points.size();
  for (std::size_t k = 2; k < poses.size(); ++k) {
    const SE3 way = poses[first_good].T_start_body.inverse() * poses[k].T_start_body;
    const SE3 true_way = drive.truth[first_good].inverse() * drive.truth[k];
    EXPECT_TRUE(is_on_the_way(poses[k].outcome)) << k;
    EXPECT_LT(distance_between(way, true_way), 2 * kClose_m) << k;
    EXPECT_LT(angle_between(way, true_way), 2 * kClose_rad) << k;
  }
}

TEST(ScanOdometer, DoesNotTakeNoiseForItsFirstMap) {
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

/// Where all is without order, that is how the world looks: ten scans later it is the map.
TEST(ScanOdometer, StartsWhereNothingHasOrder) {
  Rng rng(14);
  const LidarScan thicket = noise_scan(ScannerKind::kSpatial, 3000, rng);
  ScanOdometer odometer({0.3, ScannerKind::kSpatial}, {});
  const int patience = ScanOdometryParams().patience;
  for (int k = 0; k <= patience + 3; ++k)
    EXPECT_EQ(odometer.add({100'000'000 * k}, thicket).outcome, k < patience    ? ScanOutcome::kUnmatched
                                                                : k == patience ? ScanOutcome::kFirst
                                                                                : ScanOutcome::kRegistered)
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

TEST(ScanOdometer, AfterALongTimeWithoutScansGoesOnOnlyWhereItStood) {
  const ScanDrive drive =
      drive_along(furnished_room(), scanner_of(ScannerKind::kPlanar), around_furnished_room(40), 7);
  const auto elsewhere = drive.scans[20];  // metres away, as after a walk that nobody recorded
  for (const bool moved : {false, true}) {
    ScanOdometer odometer(scanner_traits(log_of(drive), {}), {});
    for (std::size_t k = 0; k < 5; ++k) odometer.add(drive.stamps[k], drive.scans[k]);
    const Stamp later = Stamp::from_seconds(drive.stamps[4].seconds() + 600);
    const ScanPose pose = odometer.add(later, moved ? elsewhere : drive.scans[4]);
    EXPECT_EQ(pose.outcome, moved ? ScanOutcome::kNewMap : ScanOutcome::kRegistered);
    if (moved)
      EXPECT_GT(pose.covariance.diagonal().minCoeff(), 0.2);
    else
      EXPECT_LT(distance_between(pose.T_start_body, drive.way_to(4)), kClose_m);
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

void expect_way(const std::vector<ScanPose>& found, const ScanDrive& drive, std::size_t from) {
  ASSERT_EQ(found.size(), drive.truth.size());
  for (std::size_t k = from; k < found.size(); ++k) {
    const SE3 way = found[from].T_start_body.inverse() * found[k].T_start_body;
    EXPECT_LT(distance_between(way, drive.truth[from].inverse() * drive.truth[k]), 0.05) << k;
  }
}

/// Nothing tells how fast the robot goes when its first scan is swept: by the second one it is known.
TEST(ScanOdometer, UnbendsItsFirstScanToo) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (const double stamp_at : {0.0, 0.5, 1.0}) {
      const ScanDrive drive =
          drive_along(furnished_hall(), sweeping(kind, stamp_at), fast_straight_drive(), 9);
      expect_way(odometry_of(drive), drive, 0);
    }
}

/// Where something else tells the motion to the second scan, by that.
TEST(ScanOdometer, UnbendsItsFirstScanByTheMotionThatIsTold) {
  for (const double stamp_at : {0.0, 0.5, 1.0}) {
    const Scanner scanner = sweeping(ScannerKind::kPlanar, stamp_at);
    const ScanDrive drive = drive_along(furnished_hall(), scanner, fast_straight_drive(), 9);
    ScanOdometer odometer(scanner_traits(log_of(drive), {}), {});
    std::vector<ScanPose> found;
    for (std::size_t k = 0; k < drive.scans.size(); ++k) {
      std::optional<SE3> motion;
      if (k > 0) motion = drive.truth[k - 1].inverse() * drive.truth[k];
      found.push_back(odometer.add(drive.stamps[k], drive.scans[k], motion));
    }
    expect_way(found, drive, 0);
  }
}

/// The first scan of a map that begins after a gap was unbent by the motion before that.
TEST(ScanOdometer, UnbendsTheFirstScanAfterAGap) {
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
    EXPECT_EQ(found[before].outcome, ScanOutcome::kNewMap);
    expect_way(found, drive, before);
  }
}

/// The first scan is of another room: the next two make up the map.
TEST(ScanOdometer, UnbendsTheFirstScansOfARival) {
  for (const double stamp_at : {0.0, 1.0}) {
    const Scanner scanner = sweeping(ScannerKind::kPlanar, stamp_at);
    ScanDrive drive = drive_along(furnished_hall(), scanner, fast_straight_drive(), 9);
    drive.scans[0] = drive_along(furnished_room(), scanner, around_furnished_room(40), 9).scans[0];
    const auto found = odometry_of(drive);
    EXPECT_EQ(found[1].outcome, ScanOutcome::kUnmatched);
    EXPECT_EQ(found[2].outcome, ScanOutcome::kNewMap);
    expect_way(found, drive, 2);
  }
}

/// What was given out of the first scan is given again.
TEST(ScanOdometer, GivesTheFirstCloudUnbent) {
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
