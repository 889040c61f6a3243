#include "radioslam/places/loops/scan_loops.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "lidar/scanned_room.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kKeyframeSpacing_m = 0.2;

/// Corridors around a block of 14 m by 14 m, with niches, pillars and crates.
ScannedRoom ring_of_corridors() {
  ScannedRoom ring;
  ring.boxes = {{{-10, -10, 0}, {10, 10, 3}},   {{-7, -7, 0}, {7, 7, 3}},       {{-4, -10, 0}, {-3, -9.3, 3}},
                {{2, -7.6, 0}, {3.2, -7, 2}},   {{9.2, -3, 0}, {10, -1, 3}},    {{7, 3, 0}, {7.5, 4.5, 3}},
                {{0, 9.4, 0}, {2.5, 10, 2}},    {{-5, 7, 0}, {-4.4, 7.7, 3}},   {{-10, 4, 0}, {-9.5, 5, 3}},
                {{-7.8, -2, 0}, {-7, -1.2, 3}}, {{5.5, -10, 0}, {7, -9.1, 2.5}}};
  ring.pillars = {{{-9.6, -4}, 0.2}, {{4, 9.7}, 0.25}, {{-1, -9.7}, 0.15}};
  return ring;
}

/// A keyframe per metre, once around the ring and eight metres further.
std::vector<SE3> around_the_ring() {
  std::vector<SE3> poses{pose_at(-6, -8.5, 1, 0)};
  const auto go = [&](double distance_m) {
    for (int k = 0; k < static_cast<int>(distance_m); ++k)
      poses.push_back(poses.back() * SE3::exp(planar_motion(1, 0, 0)));
  };
  const auto turn = [&] {
    for (int k = 0; k < 3; ++k)
      poses.push_back(poses.back() * SE3::exp(planar_motion(0, 0, std::numbers::pi / 6)));
  };
  go(14);
  for (int side = 0; side < 3; ++side) {
    turn();
    go(17);
  }
  turn();
  go(11);
  return poses;
}

/// Keyframes along these poses, with odometry that has random-walk noise per step.
ScanKeyframes keyframes_along(const ScannedRoom& room, const std::vector<SE3>& truth, ScannerKind kind,
                              double sigma_step_m, double sigma_step_rad, std::uint64_t seed,
                              double view_rad = 2 * std::numbers::pi) {
  Rng scans(seed), steps = scans.split("steps");
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner(360, view_rad) : Scanner();
  if (kind == ScannerKind::kSpatial) scanner.azimuths = 120;
  ScanKeyframes keyframes;
  keyframes.kind = kind;
  keyframes.spacing_m = kKeyframeSpacing_m;
  keyframes.nominal_inlier_ratio = 0.85;
  SE3::Tangent variance = SE3::Tangent::Constant(1e-7);
  variance.head<2>().setConstant(sigma_step_m * sigma_step_m);
  variance[5] = sigma_step_rad * sigma_step_rad;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    keyframes.clouds.push_back(
        CloudStore().add(pyramid_of(sweep(room, scanner, truth[k], scans), kKeyframeSpacing_m, kind)));
    if (k == 0) {
      keyframes.poses.emplace_back();
      continue;
    }
    const double x = steps.normal(0, sigma_step_m), y = steps.normal(0, sigma_step_m);
    const SE3 error = SE3::exp(planar_motion(x, y, steps.normal(0, sigma_step_rad)));
    keyframes.poses.push_back(keyframes.poses.back() * truth[k - 1].inverse() * truth[k] * error);
    keyframes.step_covariances.emplace_back(variance.asDiagonal());
  }
  return keyframes;
}

double end_error_m(const std::vector<SE3>& poses, const std::vector<SE3>& truth) {
  return distance_between(poses.back(), truth.front().inverse() * truth.back());
}

ScanLoops close_loops(const ScanKeyframes& keyframes, const ScanLoopParams& params = {}) {
  ScanLoopSearch search;
  search.loops = params;
  return close_scan_loops(keyframes, search);
}

std::size_t count_of(const ScanLoops& loops, LoopStatus status) {
  return static_cast<std::size_t>(std::count_if(loops.loops.begin(), loops.loops.end(),
                                                [&](const ScanLoop& l) { return l.status == status; }));
}

void expect_right(const ScanLoops& loops, const std::vector<SE3>& truth, double off_m) {
  for (const ScanLoop& loop : loops.loops) {
    if (loop.status != LoopStatus::kAccepted) continue;
    EXPECT_LT(loop.i, loop.j);
    EXPECT_LT(distance_between(loop.T_i_j, truth[loop.i].inverse() * truth[loop.j]), off_m)
        << loop.i << " and " << loop.j;
  }
}

TEST(CloseScanLoops, BringALongDriftBackTenfold) {
  for (const ScannerKind kind : {ScannerKind::kPlanar, ScannerKind::kSpatial}) {
    double drift_m = 0, closed_m = 0;
    const auto truth = around_the_ring();
    for (const std::uint64_t seed : {4U, 5U}) {
      const auto keyframes = keyframes_along(ring_of_corridors(), truth, kind, 0.02, 0.02, seed);
      const ScanLoops loops = close_loops(keyframes);
      drift_m += end_error_m(keyframes.poses, truth) / 2;
      closed_m += end_error_m(loops.poses, truth) / 2;
      EXPECT_GT(count_of(loops, LoopStatus::kAccepted), 1U);
      expect_right(loops, truth, 0.3);
    }
    EXPECT_GT(drift_m, 2) << "the task is too easy";
    EXPECT_LT(10 * closed_m, drift_m);
  }
}

/// A scanner that sees what is ahead shares next to nothing with itself on the way back.
TEST(CloseScanLoops, JoinTheWayBackAlongCorridorsByWhatStretchesSaw) {
  auto truth = around_the_ring();
  const std::vector<SE3> there = truth;
  for (auto pose = there.rbegin(); pose != there.rend(); ++pose)
    truth.push_back(*pose * SE3::exp(planar_motion(0, 0, std::numbers::pi)));
  const auto keyframes =
      keyframes_along(ring_of_corridors(), truth, ScannerKind::kPlanar, 0.02, 0.02, 4, std::numbers::pi);
  const ScanLoops loops = close_loops(keyframes);
  const auto is_on_the_way_back = [&](const ScanLoop& loop) {
    return loop.status == LoopStatus::kAccepted && loop.i < there.size() && loop.j >= there.size() + 10 &&
           std::abs((truth[loop.i].inverse() * truth[loop.j]).yaw()) > 2;
  };
  EXPECT_GT(std::count_if(loops.loops.begin(), loops.loops.end(), is_on_the_way_back), 3);
  expect_right(loops, truth, 0.4);
}

/// Two identical rooms, thirty metres apart.
ScannedRoom two_rooms_alike() {
  ScannedRoom rooms;
  const ScannedRoom room = furnished_room();
  for (const double x : {0.0, 30.0}) {
    const Eigen::Vector3d shift(x, 0, 0);
    for (const Box& box : room.boxes) rooms.boxes.push_back({box.low + shift, box.high + shift});
    for (const Pillar& pillar : room.pillars) rooms.pillars.push_back({pillar.centre + shift.head<2>()});
  }
  return rooms;
}

/// Through one room and, over an unobserved path, through the other.
std::vector<SE3> through_two_rooms() {
  std::vector<SE3> poses;
  for (int k = 0; k <= 15; ++k) {
    poses.push_back(pose_at(-2.4 + 2.0 * k, 0.3, 1.2, 0));
    if (std::abs(poses.back().translation().x() - 15) < 9) poses.pop_back();
  }
  return poses;
}

TEST(CloseScanLoops, DoNotTakeOneRoomForAnotherThatIsAlike) {
  const auto truth = through_two_rooms();
  for (const ScannerKind kind : {ScannerKind::kPlanar, ScannerKind::kSpatial}) {
    auto keyframes = keyframes_along(two_rooms_alike(), truth, kind, 0.3, 0.02, 6);
    const ScanLoops loops = close_loops(keyframes);
    EXPECT_EQ(count_of(loops, LoopStatus::kAccepted), 0U);
    for (std::size_t k = 0; k < truth.size(); ++k)
      EXPECT_LT(distance_between(loops.poses[k], keyframes.poses[k]), 1e-9);
    // Nor where it does not: the rooms are alike.
    for (SE3::Jacobian& covariance : keyframes.step_covariances) covariance(0, 0) = 100;
    EXPECT_EQ(count_of(close_loops(keyframes), LoopStatus::kAccepted), 0U);
  }
}

/// There and back among identical pillars every four metres.
TEST(CloseScanLoops, DoNotChooseBetweenIdenticalPlaces) {
  ScannedRoom hall;
  hall.boxes = {{{-100, -100, 0}, {100, 100, 4}}};
  for (int x = -5; x <= 5; ++x)
    for (int y = -5; y <= 5; ++y) hall.pillars.push_back({{4.0 * x, 4.0 * y}, 0.4});
  std::vector<SE3> truth;
  for (int k = 0; k <= 7; ++k) truth.push_back(pose_at(-6 + 1.5 * k, 2, 1.2, 0));
  for (int k = 7; k >= 0; --k) truth.push_back(pose_at(-6 + 1.5 * k, 2, 1.2, 3));
  auto keyframes = keyframes_along(hall, truth, ScannerKind::kPlanar, 0.01, 0.001, 7);
  for (SE3::Jacobian& covariance : keyframes.step_covariances)
    covariance.diagonal().head<2>().setConstant(2);  // it may have passed more pillars
  const ScanLoops loops = close_loops(keyframes);
  EXPECT_GT(count_of(loops, LoopStatus::kAmbiguous), 0U);
  expect_right(loops, truth, 0.3);
}

TEST(CloseScanLoops, TryNothingThatIsKnownOrNear) {
  const auto truth = around_the_ring();
  const auto known = keyframes_along(ring_of_corridors(), truth, ScannerKind::kPlanar, 1e-3, 1e-5, 8);
  EXPECT_TRUE(close_loops(known).loops.empty());
  auto keyframes = keyframes_along(ring_of_corridors(), truth, ScannerKind::kPlanar, 0.02, 0.02, 8);
  ScanLoopParams params;
  params.min_path_m = 1e6;
  EXPECT_TRUE(close_loops(keyframes, params).loops.empty());
  params = {};
  params.enabled = false;
  EXPECT_TRUE(close_loops(keyframes, params).loops.empty());
  EXPECT_EQ(close_loops(keyframes, params).poses.size(), truth.size());
  for (StoredCloud& cloud : keyframes.clouds) cloud = {};
  EXPECT_TRUE(close_loops(keyframes).loops.empty());
}

TEST(CloseScanLoops, OfHardlyAnyKeyframesThereAreNone) {
  ScanKeyframes keyframes;
  EXPECT_TRUE(close_loops(keyframes).poses.empty());
  keyframes.poses = {pose_at(1, 2, 0, 0.3)};
  keyframes.clouds.resize(1);
  const ScanLoops loops = close_loops(keyframes);
  ASSERT_EQ(loops.poses.size(), 1U);
  EXPECT_LT((loops.poses[0].inverse() * keyframes.poses[0]).log().norm(), 1e-12);
  EXPECT_TRUE(loops.loops.empty());
}

TEST(CloseScanLoops, AreNeverMoreCertainThanTheirSubmaps) {
  const auto truth = around_the_ring();
  ScanLoopParams params;
  params.min_sigma_m = 0.1;
  params.min_sigma_rad = 0.05;
  const auto keyframes = keyframes_along(ring_of_corridors(), truth, ScannerKind::kPlanar, 0.02, 0.02, 3);
  const ScanLoops loops = close_loops(keyframes, params);
  EXPECT_GT(count_of(loops, LoopStatus::kAccepted), 0U);
  for (const ScanLoop& loop : loops.loops) {
    if (loop.status != LoopStatus::kAccepted) continue;
    EXPECT_LE(loop.information.diagonal().head<3>().maxCoeff(), 1.001 / (0.1 * 0.1));
    EXPECT_LE(loop.information.diagonal().tail<3>().maxCoeff(), 1.001 / (0.05 * 0.05));
    EXPECT_GT(loop.information.eigenvalues().real().minCoeff(), -1e-6);
  }
}

TEST(CloseScanLoops, AreTheSameForAnyNumberOfThreads) {
  const auto truth = around_the_ring();
  const auto keyframes = keyframes_along(ring_of_corridors(), truth, ScannerKind::kPlanar, 0.02, 0.02, 4);
  set_thread_count(1);
  const ScanLoops alone = close_loops(keyframes);
  set_thread_count(3);
  const ScanLoops together = close_loops(keyframes);
  set_thread_count(0);
  ASSERT_EQ(alone.loops.size(), together.loops.size());
  for (std::size_t k = 0; k < alone.loops.size(); ++k) {
    EXPECT_EQ(alone.loops[k].i, together.loops[k].i);
    EXPECT_EQ(alone.loops[k].j, together.loops[k].j);
    EXPECT_EQ(alone.loops[k].status, together.loops[k].status);
    EXPECT_EQ(alone.loops[k].T_i_j.translation(), together.loops[k].T_i_j.translation());
  }
  for (std::size_t k = 0; k < truth.size(); ++k)
    EXPECT_EQ(alone.poses[k].translation(), together.poses[k].translation());
}

TEST(CloseScanLoops, HaveAReasonUnlessAccepted) {
  EXPECT_TRUE(reason(LoopStatus::kAccepted).empty());
  for (const LoopStatus status :
       {LoopStatus::kLowOverlap, LoopStatus::kTooLittleStructure, LoopStatus::kAmbiguous,
        LoopStatus::kUnmapped, LoopStatus::kAnotherStorey, LoopStatus::kRejectedByGraph})
    EXPECT_FALSE(reason(status).empty());
}

}  // namespace
}  // namespace radioslam
