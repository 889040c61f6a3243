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
        pyramid_of(sweep(room, scanner, pose, rng), kSpacing_m, ScannerKind::kSpatial));
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

/// Two rooms alike, both seen: which of them a scan is from the prediction must tell.
TEST(LoopVerification, SearchesThePlacesThatLookAlike) {
  constexpr double kApart_m = 30;
  ScannedRoom rooms;
  const ScannedRoom room = furnished_room();
  for (const double x : {0.0, kApart_m}) {
    const Eigen::Vector3d shift(x, 0, 0);
    for (const Box& box : room.boxes) rooms.boxes.push_back({box.low + shift, box.high + shift});
    for (const Pillar& pillar : room.pillars) rooms.pillars.push_back({pillar.centre + shift.head<2>()});
  }
  const ScanKeyframes seen =
      keyframes_at(rooms, {pose_at(-1, 0.3, 1.2, 0), pose_at(0, 0.3, 1.2, 0),
                           pose_at(kApart_m - 1, 0.3, 1.2, 0), pose_at(kApart_m, 0.3, 1.2, 0)});
  const std::vector<double> path_m = path_lengths(seen);
  const ScanKeyframes other = keyframes_at(rooms, {pose_at(0.2, 0.2, 1.2, 0.1)});
  const std::vector<double> other_path_m{0};
  ScanContextIndex index({}), other_index({});
  for (const ScanContext& context : keyframe_contexts(seen, path_m, 8, 5, {})) index.add(context);
  for (const ScanContext& context : keyframe_contexts(other, other_path_m, 8, 5, {}))
    other_index.add(context);
  const LoopVerification verification({}, {.target_m = 5, .storeys = Storeys::kOne}, {}, {}, {});
  const auto status = [&](double sigma_m, bool anywhere) {
    const SE3 T_i_j = seen.poses[1].inverse() * other.poses[0];
    return verification
        .verify({seen, seen.poses, path_m, &index, [](std::size_t, std::size_t) { return 0.1; }}, 1,
                {other, other.poses, other_path_m, &other_index}, 0,
                {expected_at(T_i_j, sigma_m, 0.1), anywhere})
        .status;
  };
  EXPECT_EQ(status(0.3, false), LoopStatus::kAccepted);
  EXPECT_NE(status(30, false), LoopStatus::kAccepted);
  EXPECT_NE(status(1, true), LoopStatus::kAccepted) << "nothing tells the rooms apart";
}

}  // namespace
}  // namespace radioslam
