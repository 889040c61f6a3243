// When a closure that fits is one to believe: where its alternatives are excluded.
#include "radioslam/places/loops/loop_verification.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "lidar/scanned_room.hpp"
#include "radioslam/places/keyframe_contexts.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kSpacing_m = 0.2;

/// Keyframes at these poses, without errors.
ScanKeyframes keyframes_at(const ScannedRoom& room, const std::vector<SE3>& poses) {
  Rng rng(11);
  Scanner scanner;
  scanner.azimuths = 240;
  ScanKeyframes keyframes;
  keyframes.kind = ScannerKind::kSpatial;
  keyframes.spacing_m = kSpacing_m;
  keyframes.nominal_inlier_ratio = 0.8;
  keyframes.poses = poses;
  for (const SE3& pose : poses)
    keyframes.clouds.push_back(
        CloudStore().add(pyramid_of(sweep(room, scanner, pose, rng), kSpacing_m, ScannerKind::kSpatial)));
  for (std::size_t k = 1; k < poses.size(); ++k)
    keyframes.step_covariances.emplace_back(SE3::Jacobian::Identity() * 1e-6);
  return keyframes;
}

UncertainPose<SE3> expected_at(const SE3& T, double sigma_m, double sigma_z_m) {
  UncertainPose<SE3> expected{T};
  expected.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, sigma_z_m * sigma_z_m, 1e-4, 1e-4,
      1e-3;
  return expected;
}

/// One visit of a furnished room, and a scan of it, or of one like it, expected so much higher.
ScanLoop verified(double higher_m, double sigma_z_m, Storeys storeys) {
  const ScanKeyframes keyframes = keyframes_at(
      furnished_room(), {pose_at(-1, 0.3, 1.2, 0), pose_at(0, 0.3, 1.2, 0), pose_at(0.2, 0.4, 1.2, 0.1)});
  const std::vector<double> path_m{0, 1, 50};
  const PlacedKeyframes robot{keyframes, keyframes.poses, path_m};
  const LoopVerification verification({}, {.target_m = 5, .storeys = storeys}, {}, {}, {});
  SE3 expected = keyframes.poses[1].inverse() * keyframes.poses[2];
  expected = SE3(expected.translation() + Eigen::Vector3d(0, 0, higher_m), expected.rotation());
  return verification.verify(robot, 1, robot, 2, {expected_at(expected, 0.2, sigma_z_m)});
}

TEST(LoopVerification, AcceptsWhatIsWhereItIsExpected) {
  const ScanLoop loop = verified(0, 0.3, Storeys::kSeveral);
  EXPECT_EQ(loop.status, LoopStatus::kAccepted);
  EXPECT_LT(loop.doubt.value_or(1), 0.01);
}

/// A scan fits the storey below as well as its own, which was never seen.
TEST(LoopVerification, DoesNotTieStoreysTogether) {
  for (const double sigma_z_m : {1.5, 3.0, 10.0})
    EXPECT_EQ(verified(3.2, sigma_z_m, Storeys::kSeveral).status, LoopStatus::kAnotherStorey) << sigma_z_m;
  EXPECT_EQ(verified(3.2, 3, Storeys::kOne).status, LoopStatus::kAccepted) << "a robot that stays on one";
  EXPECT_EQ(verified(0, 10, Storeys::kSeveral).status, LoopStatus::kAnotherStorey)
      << "the height says nothing";
  EXPECT_EQ(verified(0.05, 1.5, Storeys::kSeveral).status, LoopStatus::kAccepted);
}

TEST(LoopVerification, NeedsMoreThanGround) {
  ScannedRoom field;
  field.boxes = {{{-300, -300, 0}, {300, 300, 60}}};
  const ScanKeyframes keyframes =
      keyframes_at(field, {pose_at(-1, 0, 1.2, 0), pose_at(0, 0, 1.2, 0), pose_at(0.3, 0, 1.2, 0)});
  const std::vector<double> path_m{0, 1, 50};
  const PlacedKeyframes robot{keyframes, keyframes.poses, path_m};
  const LoopVerification verification({}, {.target_m = 5}, {}, {}, {});
  const ScanLoop loop = verification.verify(robot, 1, robot, 2, {expected_at(pose_at(2, 0, 0, 0), 1, 0.1)});
  EXPECT_NE(loop.status, LoopStatus::kAccepted);
}

/// Rooms like this one, each `apart` from the last.
ScannedRoom rooms_alike(const ScannedRoom& room, const std::vector<Eigen::Vector3d>& at) {
  ScannedRoom rooms;
  for (const Eigen::Vector3d& shift : at) {
    for (const Box& box : room.boxes) rooms.boxes.push_back({box.low + shift, box.high + shift});
    for (const Pillar& pillar : room.pillars) rooms.pillars.push_back({pillar.centre + shift.head<2>()});
  }
  return rooms;
}

/// A robot that saw these places, and another's scan that is compared with the second of them.
struct ComparedRobots {
  ScanKeyframes seen, other;
  std::vector<double> path_m, other_path_m{0};
  ScanContextIndex index{{}}, other_index{{}};

  ComparedRobots(const ScannedRoom& rooms, const std::vector<SE3>& places, const SE3& scan)
      : seen(keyframes_at(rooms, places)), other(keyframes_at(rooms, {scan})), path_m(path_lengths(seen)) {
    index = keyframe_index(seen, path_m, 8, 5, {});
    other_index = keyframe_index(other, other_path_m, 8, 5, {});
  }

  SE3 truth() const { return seen.poses[1].inverse() * other.poses[0]; }
  ScanLoop verified(const ExpectedPlace& expected, Storeys storeys) const {
    const LoopVerification verification({}, {.target_m = 5, .storeys = storeys}, {}, {}, {});
    return verification.verify(
        {seen, seen.poses, path_m, &index, [](std::size_t, std::size_t) { return 0.1; }}, 1,
        {other, other.poses, other_path_m, &other_index}, 0, expected);
  }
};

constexpr double kApart_m = 30;

ComparedRobots two_rooms() {
  return {rooms_alike(furnished_room(), {{0, 0, 0}, {kApart_m, 0, 0}}),
          {pose_at(-1, 0.3, 1.2, 0), pose_at(0, 0.3, 1.2, 0), pose_at(kApart_m - 1, 0.3, 1.2, 0),
           pose_at(kApart_m, 0.3, 1.2, 0)},
          pose_at(0.2, 0.2, 1.2, 0.1)};
}

/// Two rooms alike, both seen: which of them a scan is from the prediction must show.
TEST(LoopVerification, SearchesThePlacesThatLookAlike) {
  const ComparedRobots robots = two_rooms();
  const auto status = [&](double sigma_m, bool anywhere) {
    return robots
        .verified({.T_i_j = expected_at(robots.truth(), sigma_m, 0.1), .anywhere = anywhere}, Storeys::kOne)
        .status;
  };
  EXPECT_EQ(status(0.3, false), LoopStatus::kAccepted);
  EXPECT_NE(status(30, false), LoopStatus::kAccepted);
  EXPECT_NE(status(1, true), LoopStatus::kAccepted) << "nothing distinguishes the rooms";
}

/// A second alignment expects the scan in the other room, with this weight.
TEST(LoopVerification, DoubtsWhatAnotherAlignmentExplainsAsWellByItsWeight) {
  const ComparedRobots robots = two_rooms();
  const auto verified = [&](double weight, double farther_m) {
    const SE3 other(robots.truth().translation() + Eigen::Vector3d(farther_m, 0, 0),
                    robots.truth().rotation());
    return robots.verified({.T_i_j = expected_at(robots.truth(), 0.3, 0.1),
                            .weight = 1 - weight,
                            .alternatives = {{other, weight}}},
                           Storeys::kOne);
  };
  for (const double weight : {0.1, 0.4}) {
    const ScanLoop loop = verified(weight, kApart_m);
    EXPECT_EQ(loop.status, LoopStatus::kAmbiguous);
    EXPECT_NEAR(loop.doubt.value_or(0), weight, 0.3 * weight);
  }
  EXPECT_NE(verified(0.9, kApart_m).status, LoopStatus::kAccepted);
  EXPECT_EQ(verified(0.02, kApart_m).status, LoopStatus::kAccepted);
  EXPECT_EQ(verified(0.4, 0).status, LoopStatus::kAccepted) << "both expect it here";
  EXPECT_EQ(verified(0.4, 15).status, LoopStatus::kAccepted) << "no such place was seen there";
}

/// The other robot is on the upper one of two storeys, both seen by the first, and nothing predicts where.
TEST(LoopVerification, WithoutAPredictionComparesTheStoreysThatWereSeen) {
  constexpr double kStorey_m = 3.5;
  ScannedRoom other_below = furnished_room();
  other_below.boxes = {other_below.boxes.front(), {{-3, -1, 0}, {-1, 1, 1.5}}, {{3, -3, 0}, {5, -1, 2}}};
  for (const bool are_alike : {true, false}) {
    ScannedRoom rooms = rooms_alike(furnished_room(), {{0, 0, kStorey_m}});
    rooms.pillars.clear();  // of infinite height
    ScannedRoom below = are_alike ? furnished_room() : other_below;
    rooms.boxes.insert(rooms.boxes.end(), below.boxes.begin(), below.boxes.end());
    const double up = kStorey_m + 1.2;
    const ComparedRobots robots(rooms,
                                {pose_at(-1, 0.3, up, 0), pose_at(0, 0.3, up, 0), pose_at(20, 0.3, 1.2, 0),
                                 pose_at(-1, 0.3, 1.2, 0), pose_at(0, 0.3, 1.2, 0)},
                                pose_at(0.2, 0.2, up, 0.1));
    const ScanLoop loop =
        robots.verified({.T_i_j = expected_at(robots.truth(), 1, 0.1), .anywhere = true}, Storeys::kSeveral);
    EXPECT_EQ(loop.status, are_alike ? LoopStatus::kAmbiguous : LoopStatus::kAccepted) << are_alike;
    if (!are_alike) {
      EXPECT_GT(loop.doubt.value_or(0), 0.01) << "storeys that nobody saw";
    }
  }
}

}  // namespace
}  // namespace radioslam
