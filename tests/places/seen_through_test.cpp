// Halls of identical pillars: scans fit bays that are not theirs, whole ways of scans only where the hall is
// the same when turned.
#include "radioslam/places/seen_through.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "lidar/scanned_room.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kSpacing_m = 0.2;

ScanPyramid scan_at(const ScannedRoom& room, const SE3& pose, ScannerKind kind) {
  Rng rng(3);
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner{};
  scanner.max_m = 12;
  return pyramid_of(sweep(room, scanner, pose, rng), kSpacing_m, kind);
}

/// 24 by 20 metres, pillars every four.
ScannedRoom pillared_hall() {
  ScannedRoom hall;
  hall.boxes = {{{0, 0, 0}, {24, 20, 4}}};
  for (int i = 1; i < 6; ++i)
    for (int j = 1; j < 5; ++j) hall.pillars.push_back({{4.0 * i, 4.0 * j}, 0.3});
  return hall;
}

/// A robot on its way through the hall, without errors.
struct Visitor {
  ScanKeyframes keyframes;
  std::vector<double> path_m;

  Visitor(const ScannedRoom& room, const std::vector<SE3>& poses) {
    keyframes.poses = poses;
    keyframes.spacing_m = kSpacing_m;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      keyframes.clouds.push_back(CloudStore().add(scan_at(room, poses[k], ScannerKind::kSpatial)));
      path_m.push_back(4.0 * static_cast<double>(k));
    }
  }
  PlacedKeyframes placed() const {
    return {keyframes, keyframes.poses, path_m, nullptr, [](std::size_t, std::size_t) { return 0.02; }};
  }
};

class HallVisitors : public ::testing::Test {
 protected:
  /// The robots' maps, the second moved in the hall's frame.
  SeenThrough after(const SE3& moved) const {
    const SE3 T_a_b = a.keyframes.poses[1].inverse() * moved * b.keyframes.poses[2];
    return seen_through(a.placed(), b.placed(), {{1, 2, T_a_b, 0.02}});
  }

  ScannedRoom hall = pillared_hall();
  Visitor a{hall, {pose_at(2, 2, 1, 0), pose_at(6, 2, 1, 0), pose_at(10, 2, 1, 0), pose_at(14, 2, 1, 1)}};
  Visitor b{hall, {pose_at(2, 6, 1, 0), pose_at(6, 6, 1, 0), pose_at(10, 6, 1, 0), pose_at(10, 10, 1, 2)}};
};

TEST(Panorama, TellsWhatWasSeenFromWhatWasSeenThrough) {
  ScannedRoom room;
  room.boxes = {{{-8, -8, 0}, {8, 8, 4}}, {{3, -1, 0}, {4, 1, 4}}};
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    const Panorama panorama(scan_at(room, pose_at(0, 0, 1, 0), kind), kind);
    EXPECT_EQ(panorama.of({3, 0, 0}, 0.3F), Panorama::View::kSeen) << "the crate";
    EXPECT_EQ(panorama.of({7.8F, 0, 0}, 0.3F), Panorama::View::kNothing) << "the wall behind the crate";
    EXPECT_EQ(panorama.of({1, 0, 0}, 0.3F), Panorama::View::kThrough) << "before the crate";
    EXPECT_EQ(panorama.of({-8, 0.5F, 0}, 0.3F), Panorama::View::kSeen) << "the other wall";
    EXPECT_EQ(panorama.of({-5, 0.5F, 0}, 0.3F), Panorama::View::kThrough);
    EXPECT_EQ(panorama.of({-5, 0.5F, 0}, 4), Panorama::View::kSeen) << "hardly known";
    EXPECT_EQ(panorama.of({-30, 0, 0}, 0.3F), Panorama::View::kNothing) << "beyond all returns";
  }
  const ScannerKind spatial = ScannerKind::kSpatial;
  EXPECT_EQ(Panorama(scan_at(room, pose_at(0, 0, 1, 0), spatial), spatial).of({-2, 0, 2.5F}, 0.3F),
            Panorama::View::kNothing)
      << "above all beams";
}

TEST_F(HallVisitors, SeeNothingWhereTheOtherHasWallsIfTheFrameIsRight) {
  const SeenThrough right = after(SE3());
  EXPECT_GT(right.all(), 1000U);
  EXPECT_LT(right.share(), 0.01);
}

TEST_F(HallVisitors, SeeThroughEachOthersWallsAfterAShiftByABay) {
  for (const SE3& moved : {pose_at(4, 0, 0, 0), pose_at(-4, 0, 0, 0), pose_at(0, 4, 0, 0)})
    EXPECT_GT(after(moved).share(), 0.03) << moved.translation().transpose();
}

/// Scans alone cannot tell: the hall looks the same after half a turn.
TEST_F(HallVisitors, AgreeInAHallThatIsTurnedByHalf) {
  const SeenThrough turned = after(pose_at(24, 20, 0, std::numbers::pi));
  EXPECT_LT(turned.share(), 0.01);
}

TEST_F(HallVisitors, SayNothingWhereOdometryTellsTooLittle) {
  const SE3 T_a_b = a.keyframes.poses[1].inverse() * b.keyframes.poses[2];
  EXPECT_EQ(seen_through(a.placed(), b.placed(), {{1, 2, T_a_b, 2.0}}).all(), 0U);
}

}  // namespace
}  // namespace radioslam
