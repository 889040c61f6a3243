#include "radioslam/sim/sensors/packet_radio.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/sim/worlds/arena.hpp"

namespace radioslam {
namespace {

PacketRadioParams quiet() {
  PacketRadioParams params;
  params.sigma_shadowing_db = 0;
  params.sigma_aoa_rad = 1e-6;
  return params;
}

TEST(PacketRadio, FallsWithDistanceAsTheExponentSays) {
  const PacketRadio radio({}, quiet(), Rng(1));
  const double near = radio.receive({0, 0}, {2, 0}, Rng(2)).esnr_db;
  const double far = radio.receive({0, 0}, {20, 0}, Rng(2)).esnr_db;
  EXPECT_NEAR(near, 55 - 22 * std::log10(2), 0.01);
  EXPECT_NEAR(near - far, 22, 0.01);
}

TEST(PacketRadio, ArrivesFromTheTransmitterAndFromItsImage) {
  WallSegment wall;
  wall.begin_m = {-50, 5};
  wall.end_m = {50, 5};
  const PacketRadio radio({wall}, quiet(), Rng(1));
  const PacketReception packet = radio.receive({10, 0}, {0, 0}, Rng(2));
  ASSERT_EQ(packet.paths.size(), 2U);
  EXPECT_NEAR(packet.paths[0].azimuth_rad, 0, 1e-4);
  EXPECT_NEAR(packet.paths[1].azimuth_rad, M_PI / 4, 1e-4);  // the image is at (10, 10)
  EXPECT_GT(packet.paths[0].power_db, packet.paths[1].power_db);
}

TEST(PacketRadio, BehindAWallAReflectionMayBeTheStrongest) {
  WallSegment between, beside;
  between.begin_m = {5, -1};
  between.end_m = {5, 1};
  beside.begin_m = {-50, 4};
  beside.end_m = {50, 4};
  PacketRadioParams params = quiet();
  params.wall_loss_db = 30;
  const PacketRadio radio({between, beside}, params, Rng(1));
  const PacketReception packet = radio.receive({10, 0}, {0, 0}, Rng(2));
  EXPECT_NEAR(packet.paths.front().azimuth_rad, std::atan2(8, 10), 1e-4);
}

TEST(PacketRadio, APacketDependsOnItsNoiseAlone) {
  const Arena arena(30, 3, Rng(5));
  const PacketRadio radio(arena.walls(), {}, Rng(1));
  const auto a = radio.receive({3, 4}, {20, 11}, Rng(7)), b = radio.receive({3, 4}, {20, 11}, Rng(7));
  EXPECT_EQ(a.esnr_db, b.esnr_db);
  EXPECT_EQ(a.paths.front().azimuth_rad, b.paths.front().azimuth_rad);
  EXPECT_NE(a.paths.front().azimuth_rad, radio.receive({3, 4}, {20, 11}, Rng(8)).paths.front().azimuth_rad);
}

}  // namespace
}  // namespace radioslam
