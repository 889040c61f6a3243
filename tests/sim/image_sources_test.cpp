#include "radioslam/sim/sensors/image_sources.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

const Eigen::Vector3d kTransmitter(1, 2, 0.5), kReceiver(4, 3, 1.5);
const WallSegment kBelow{{-50, 0}, {50, 0}, -0.4, 8};
const WallSegment kLeft{{0, -50}, {0, 50}, 0.5, 8};

TEST(ImageSources, TheStraightPathComesFirst) {
  const auto paths = image_paths(kTransmitter, kReceiver, {}, {});
  ASSERT_EQ(paths.size(), 1U);
  EXPECT_NEAR(paths[0].length_m, std::sqrt(11.0), 1e-12);
  EXPECT_NEAR(paths[0].amplitude, 1 / std::sqrt(11.0), 1e-12);
  EXPECT_LT((paths[0].direction - Eigen::Vector3d(-3, -1, -1) / std::sqrt(11.0)).norm(), 1e-12);
}

TEST(ImageSources, AWallShowsTheTransmitterBehindItself) {
  const auto paths = image_paths(kTransmitter, kReceiver, {kBelow}, {});
  ASSERT_EQ(paths.size(), 2U);  // the image is at (1, -2, 0.5)
  EXPECT_EQ(paths[1].bounces, 1);
  EXPECT_NEAR(paths[1].length_m, std::sqrt(35.0), 1e-12);
  EXPECT_NEAR(paths[1].amplitude, -0.4 / std::sqrt(35.0), 1e-12);
  EXPECT_LT((paths[1].direction - Eigen::Vector3d(-3, -5, -1) / std::sqrt(35.0)).norm(), 1e-12);
}

TEST(ImageSources, AFiniteWallReflectsOnItsSegmentOnly) {
  WallSegment wall = kBelow;  // the path bounces at x = 2.2
  wall.begin_m.x() = 2.21;
  EXPECT_EQ(image_paths(kTransmitter, kReceiver, {wall}, {}).size(), 1U);
  wall.begin_m.x() = 2.19;
  EXPECT_EQ(image_paths(kTransmitter, kReceiver, {wall}, {}).size(), 2U);
  wall.end_m.x() = 2.195;
  EXPECT_EQ(image_paths(kTransmitter, kReceiver, {wall}, {}).size(), 1U);
}

TEST(ImageSources, ACornerShowsTheImageOfAnImageOnce) {
  const auto paths = image_paths(kTransmitter, kReceiver, {kBelow, kLeft}, {});
  ASSERT_EQ(paths.size(), 4U);
  EXPECT_EQ(paths[3].bounces, 2);  // of (-1, -2, 0.5)
  EXPECT_NEAR(paths[3].length_m, std::sqrt(25 + 25 + 1.0), 1e-12);
  EXPECT_NEAR(paths[3].amplitude, -0.4 * 0.5 / std::sqrt(51.0), 1e-12);
  EXPECT_EQ(image_paths(kTransmitter, kReceiver, {kBelow, kLeft}, {1, 0}).size(), 3U);
  EXPECT_EQ(image_paths(kTransmitter, kReceiver, {kBelow, kLeft}, {0, 0}).size(), 1U);
}

TEST(ImageSources, ParallelWallsReflectToAndFro) {
  const WallSegment above{{-50, 5}, {50, 5}, 0.5, 8};
  const auto paths = image_paths(kTransmitter, kReceiver, {kBelow, above}, {});
  ASSERT_EQ(paths.size(), 5U);  // images of images: 2 -> -2 -> 12 and 2 -> 8 -> -8
  EXPECT_NEAR(paths[3].length_m, std::sqrt(9 + 81 + 1.0), 1e-12);
  EXPECT_NEAR(paths[4].length_m, std::sqrt(9 + 121 + 1.0), 1e-12);
}

TEST(ImageSources, WallsInThePathAttenuate) {
  const WallSegment between{{2.5, 0}, {2.5, 50}, 0, 20};
  const auto paths = image_paths(kTransmitter, kReceiver, {kBelow, between}, {1, 6});
  ASSERT_GE(paths.size(), 2U);
  EXPECT_NEAR(paths[0].amplitude, std::pow(10, -26.0 / 20) / std::sqrt(11.0), 1e-12);
  EXPECT_NEAR(paths[1].amplitude, -0.4 * 0.1 / std::sqrt(35.0), 1e-12)
      << "it passes the wall after its bounce";
}

TEST(ImageSources, AreTheSameInBothDirections) {
  const std::vector<WallSegment> walls{
      kBelow, kLeft, {{-50, 5}, {50, 5}, -0.3, 5}, {{2.5, 0}, {2.5, 3}, -0.2, 20}};
  const auto there = image_paths(kTransmitter, kReceiver, walls, {});
  const auto back = image_paths(kReceiver, kTransmitter, walls, {});
  ASSERT_EQ(there.size(), back.size());
  double there_sum = 0, back_sum = 0;  // double bounces come in another order
  for (std::size_t k = 0; k < there.size(); ++k) {
    there_sum += there[k].amplitude * std::sin(there[k].length_m);
    back_sum += back[k].amplitude * std::sin(back[k].length_m);
  }
  EXPECT_NEAR(there_sum, back_sum, 1e-12);
}

TEST(WallSegment, MeasuresTheDistanceToAPoint) {
  const WallSegment wall{{0, 0}, {4, 0}};
  EXPECT_NEAR(wall.distance_m({1, -2}), 2, 1e-12);
  EXPECT_NEAR(wall.distance_m({7, 4}), 5, 1e-12);
}

}  // namespace
}  // namespace radioslam
