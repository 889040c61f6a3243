// Simulated exchanges processed by the estimator for recorded ones; the two share no model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <vector>

#include "io/temporary_folder.hpp"
#include "radioslam/io/csi/csi_band.hpp"  // beside the simulator's: one name for both was two definitions
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/radio/channel/two_way_channel.hpp"
#include "radioslam/sim/scenarios/csi_room.hpp"

namespace radioslam {
namespace {

/// A mission written to files and read back.
struct Recorded {
  Mission mission;
  Truth truth;

  explicit Recorded(const CsiRoomParams& params) {
    const TemporaryFolder folder;
    const Simulation simulation = simulate_csi_room(params, 5);
    write_mission(folder.path(), simulation.mission, simulation.truth);
    mission = read_mission(folder.path());
    truth = read_truth(folder.path(), mission);
  }
  const CsiCapture& capture(std::size_t robot) const { return mission.robots[robot].csi->captures.at(0); }
  Eigen::Vector3d antenna_m(std::size_t robot, Stamp stamp) const {
    return *truth.robots[robot].poses.at(stamp) * mission.robots[robot].csi->antennas_m.at(0);
  }
};

CsiRoomParams open_room() {
  CsiRoomParams params;
  params.robots = 2;
  params.max_bounces = 0;
  params.inner_walls = 0;
  params.drives.turns_per_robot = 1;
  return params;
}

/// The first half of the first robot's capture, recorded while it drove and the other robot replied.
CsiCapture first_leg(const CsiCapture& capture) {
  CsiCapture leg = capture;
  std::erase_if(leg.packets, [&](const CsiPacket& packet) {
    return seconds_between(capture.packets.front().stamp, packet.stamp) >
           seconds_between(capture.packets.front().stamp, capture.packets.back().stamp) / 2;
  });
  std::uint32_t pause_after = 0;
  for (std::size_t k = 1; k < leg.packets.size() && pause_after == 0; ++k)
    if (seconds_between(leg.packets[k - 1].stamp, leg.packets[k].stamp) > 0.3)
      pause_after = *leg.packets[k - 1].counter;
  if (pause_after > 0)
    std::erase_if(leg.packets, [&](const CsiPacket& packet) { return *packet.counter > pause_after; });
  return leg;
}

/// Agreement of the product's phases with those of twice the true distance, 0 to 1.
double agreement(const Recorded& recorded, const TwoWayChannel& channel) {
  std::complex<double> sum = 0;
  double count = 0;
  for (std::size_t k = 0; k < channel.stamps.size(); ++k) {
    const double distance_m =
        (recorded.antenna_m(0, channel.stamps[k]) - recorded.antenna_m(1, channel.stamps[k])).norm();
    const std::complex<double> p =
        channel.product(static_cast<Eigen::Index>(k), 15) + channel.product(static_cast<Eigen::Index>(k), 14);
    sum += p / std::abs(p) *
           std::polar(1.0, 4 * std::numbers::pi * distance_m * recorded.mission.robots[0].csi->carrier_hz /
                               299792458.0);
    count += 1;
  }
  return std::abs(sum) / count;
}

TEST(SimulatedCsi, TheEstimatorsProductFollowsTheTrueDistance) {
  const Recorded recorded(open_room());
  const auto channel = two_way_channel(first_leg(recorded.capture(0)),
                                       *recorded.mission.robots[1].csi->address, recorded.capture(1), {})
                           .channel;
  ASSERT_TRUE(channel);
  EXPECT_GT(channel->paired, 500U);
  EXPECT_GT(std::abs(channel->frequency_offset_hz), 1000) << "or the test shows nothing";
  EXPECT_GT(*channel->coherence, 0.95);
  EXPECT_GT(agreement(recorded, *channel), 0.9);
  TwoWayParams blind;
  blind.max_offset_hz = 100;
  const auto jittering = two_way_channel(first_leg(recorded.capture(0)),
                                         *recorded.mission.robots[1].csi->address, recorded.capture(1), blind)
                             .channel;
  EXPECT_LT(agreement(recorded, *jittering), agreement(recorded, *channel) - 0.03);
}

TEST(SimulatedCsi, WrongStampsBreakTheAgreement) {
  CsiRoomParams params = open_room();
  params.cards.stamp_offset_s = 1;
  const Recorded recorded(params);
  const auto channel = two_way_channel(first_leg(recorded.capture(0)),
                                       *recorded.mission.robots[1].csi->address, recorded.capture(1), {})
                           .channel;
  ASSERT_TRUE(channel);
  EXPECT_LT(agreement(recorded, *channel), 0.5);
}

/// Packets of every leg in which this robot sends and moves: the counters of a leg are consecutive.
std::vector<CsiCapture> legs_of(const Recorded& recorded, std::size_t robot, MacAddress sender) {
  std::vector<CsiCapture> legs;
  std::optional<Stamp> last;
  for (const CsiPacket& packet : recorded.capture(robot).packets) {
    if (packet.sender != sender) continue;
    if (!last || seconds_between(*last, packet.stamp) > 0.3) {
      legs.emplace_back();
      legs.back().subcarrier_hz = recorded.capture(robot).subcarrier_hz;
    }
    legs.back().packets.push_back(packet);
    last = packet.stamp;
  }
  std::erase_if(legs, [&](const CsiCapture& leg) {
    return (recorded.antenna_m(robot, leg.packets.front().stamp) -
            recorded.antenna_m(robot, leg.packets.back().stamp))
               .norm() < 0.1;
  });
  return legs;
}

/// Azimuth in the common frame, from the middle of the leg, at which a source at the true distance explains
/// the product best.
double best_azimuth_rad(const Recorded& recorded, const TwoWayChannel& channel, std::size_t robot,
                        const Eigen::Vector3d& middle_m, double distance_m) {
  const double per_metre =
      4 * std::numbers::pi * recorded.mission.robots[robot].csi->carrier_hz / 299792458.0;
  double best = -1, best_rad = 0;
  for (int degree = 0; degree < 360; ++degree) {
    const double azimuth_rad = degree * std::numbers::pi / 180;
    const Eigen::Vector3d source_m =
        middle_m + distance_m * Eigen::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0);
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < channel.stamps.size(); k += 2) {
      const auto p = channel.product(static_cast<Eigen::Index>(k), 15);
      const double away_m = (recorded.antenna_m(robot, channel.stamps[k]) - source_m).norm();
      if (std::abs(p) > 0) sum += p / std::abs(p) * std::polar(1.0, per_metre * away_m);
    }
    if (std::abs(sum) <= best) continue;
    best = std::abs(sum);
    best_rad = azimuth_rad;
  }
  return best_rad;
}

std::vector<double> direction_errors_rad(const Recorded& recorded) {
  std::vector<double> errors;
  for (std::size_t asker = 0; asker < recorded.mission.robots.size(); ++asker)
    for (std::size_t other = 0; other < recorded.mission.robots.size(); ++other) {
      if (other == asker) continue;
      const MacAddress sender = *recorded.mission.robots[other].csi->address;
      for (const CsiCapture& leg : legs_of(recorded, asker, sender)) {
        const auto channel = two_way_channel(leg, sender, recorded.capture(other), {}).channel;
        const Stamp middle = channel->stamps[channel->stamps.size() / 2];
        const Eigen::Vector3d middle_m = recorded.antenna_m(asker, middle);
        const Eigen::Vector3d way = recorded.antenna_m(other, middle) - middle_m;
        const double azimuth_rad = best_azimuth_rad(recorded, *channel, asker, middle_m, way.norm());
        const double error_rad =
            std::remainder(azimuth_rad - std::atan2(way.y(), way.x()), 2 * std::numbers::pi);
        errors.push_back(std::abs(error_rad));
      }
    }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(SimulatedCsi, LegsOfAnOpenRoomPointAtTheOthers) {
  CsiRoomParams params = open_room();
  params.robots = 3;
  params.drives.turns_per_robot = 2;
  const auto errors = direction_errors_rad(Recorded(params));
  ASSERT_EQ(errors.size(), 12U);
  EXPECT_LT(errors.back(), 0.02);
}

TEST(SimulatedCsi, MostLegsOfARoomWithWallsDoToo) {
  CsiRoomParams params;
  params.drives.turns_per_robot = 3;
  const auto errors = direction_errors_rad(Recorded(params));
  ASSERT_EQ(errors.size(), 18U);
  EXPECT_LT(errors[9], 0.02);
  EXPECT_GT(errors.back(), 0.1) << "walls mislead some";
}

}  // namespace
}  // namespace radioslam
