#include "radioslam/eval/mirror_image.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "eval/teams.hpp"

namespace radioslam {
namespace {

using test::changed;
using test::estimate_from;
using test::noise;
using test::winding_team;

/// The plane's mirror image, turned, in the plane or in space.
SE3 mirrored(const SE3& pose) {
  const Eigen::Vector3d p = pose.translation();
  return lift(SE2({7, 2}, 1)) * SE3({p.x(), -p.y(), p.z()}, pose.rotation());
}

std::vector<MirrorImage> images(const std::vector<EstimatedTrajectory>& estimate, const Truth& truth,
                                int dimension = 2) {
  return evaluate_trajectories(estimate, truth, dimension).mirror_images;
}

TEST(MirrorImage, AMirroredTruthIsNotedForTheTeamAlone) {
  for (const int dimension : {2, 3})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Truth sound = winding_team(seed, 3, 100);
      Truth truth = sound;
      for (RobotTruth& robot : truth.robots) robot.poses = changed(robot.poses, mirrored);
      const auto found = images(estimate_from(sound, [](const SE3& pose) { return pose; }), truth, dimension);
      ASSERT_EQ(found.size(), 1U) << "seed " << seed;
      EXPECT_EQ(found.front().robot, "");
      EXPECT_LT(found.front().reflected_rmse_m, 1e-6);
      EXPECT_GT(found.front().rigid_rmse_m, 1);
      ASSERT_EQ(mirror_notes(found).size(), 1U);
      EXPECT_NE(mirror_notes(found).front().find("only as a mirror image"), std::string::npos);
    }
}

TEST(MirrorImage, OneMirroredRobotIsNamed) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Truth sound = winding_team(seed, 3, 100);
    Truth truth = sound;
    truth.robots[1].poses = changed(truth.robots[1].poses, mirrored);
    Rng rng(seed);
    const auto found = images(estimate_from(sound, noise(rng)), truth);
    ASSERT_EQ(found.size(), 1U) << "seed " << seed;
    EXPECT_EQ(found.front().robot, "b");
    EXPECT_NE(mirror_notes(found).front().find("robot b"), std::string::npos);
  }
}

TEST(MirrorImage, SoundTruthsAreNot) {
  for (const int dimension : {2, 3})
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      const Truth truth = winding_team(seed, 3, 30);
      Rng rng(seed);
      EXPECT_TRUE(images(estimate_from(truth, noise(rng)), truth, dimension).empty()) << "seed " << seed;
    }
}

/// One robot on a path given by its offset from a line, estimated with errors of about 0.6 m.
void expect_no_image(const std::function<double(int)>& offset_m, int poses, int dimension = 2) {
  std::vector<StampedPose<SE3>> path;
  for (int i = 0; i < poses; ++i)
    path.push_back({Stamp::from_seconds(i), lift(SE2({double(i), offset_m(i)}, 0))});
  const Truth truth{{{"a", Trajectory<SE3>(path)}}};
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Rng rng(seed);
    EXPECT_TRUE(images(estimate_from(truth, noise(rng)), truth, dimension).empty()) << "seed " << seed;
  }
}

TEST(MirrorImage, StraightAndSymmetricalPathsAreNot) {
  expect_no_image([](int) { return 0.0; }, 60);
  expect_no_image([](int i) { return i % 2 == 0 ? 2.0 : -2.0; }, 60);     // a zigzag
  expect_no_image([](int i) { return 0.02 * (i - 30) * (i - 30); }, 60);  // a parabola
  expect_no_image([](int) { return 0.0; }, 3);                            // too short to test
}

/// A reflection in a planar path's own plane changes nothing in space.
TEST(MirrorImage, APlanarPathInSpaceFitsBoth) {
  const Truth flat = [] {
    Truth truth = winding_team(3, 1, 60);
    truth.robots[0].poses =
        changed(truth.robots[0].poses, [](const SE3& pose) { return lift(flatten(pose)); });
    return truth;
  }();
  const auto estimate = estimate_from(flat, mirrored);
  EXPECT_TRUE(images(estimate, flat, 3).empty());
  EXPECT_EQ(images(estimate, flat, 2).size(), 1U);
}

}  // namespace
}  // namespace radioslam
