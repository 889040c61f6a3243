#include "radioslam/sim/scenarios/csi_room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/mission/wifi_channel.hpp"
#include "radioslam/sim/motion/stamps.hpp"
#include "radioslam/sim/sensors/csi_exchange.hpp"

namespace radioslam {
namespace {

constexpr std::uint64_t kFirstAddress = 0x0016ea000001;  // 00:16:ea is Intel's prefix
constexpr int kStartDraws = 100;
constexpr double kInnerWallReach = 0.5;
constexpr std::array<double, 2> kInnerWallsAt = {0.35, 0.65};  ///< ratios of the room's first side

double distance_to_walls_m(const std::vector<WallSegment>& walls, const Eigen::Vector2d& part) {
  double least = std::numeric_limits<double>::infinity();
  for (const WallSegment& wall : walls) least = std::min(least, wall.distance_m(part));
  return least;
}

/// Distributed starts in the room: each the draw that is furthest from walls (counted twice) and earlier
/// robots.
std::vector<SE2> draw_room_starts(const CsiRoomParams& params, const std::vector<WallSegment>& walls,
                                  const Rng& rng) {
  std::vector<SE2> starts;
  for (std::size_t r = 0; r < static_cast<std::size_t>(params.robots); ++r) {
    Rng own = rng.split(r);
    SE2 best;
    double best_m = -1;
    for (int draw = 0; draw < kStartDraws; ++draw) {
      const double x = own.uniform(0, params.room_x_m), y = own.uniform(0, params.room_y_m);
      const SE2 start({x, y}, own.uniform(-std::numbers::pi, std::numbers::pi));
      double clear_m = 2 * distance_to_walls_m(walls, start.translation());
      for (const SE2& other : starts)
        clear_m = std::min(clear_m, (other.translation() - start.translation()).norm());
      if (clear_m <= best_m) continue;
      best_m = clear_m;
      best = start;
    }
    starts.push_back(best);
  }
  return starts;
}

/// The team's true motion.
struct TeamMotion {
  std::vector<SE2> starts;
  std::vector<DriveLeg> legs;
  double end_s = 0;

  SE2 pose_at(std::size_t robot, double t_s) const { return pose_in_turns(legs, robot, starts[robot], t_s); }
};

TeamMotion draw_motion(const CsiRoomParams& params, const std::vector<WallSegment>& walls, const Rng& rng) {
  TeamMotion motion;
  motion.starts = draw_room_starts(params, walls, rng.split("starts"));
  motion.legs = draw_turns(
      motion.starts, [&](const Eigen::Vector2d& part) { return distance_to_walls_m(walls, part); },
      params.drives, rng.split("legs"));
  motion.end_s = params.drives.pause_s + (motion.legs.empty() ? 0 : motion.legs.back().end_s);
  return motion;
}

std::vector<Eigen::Vector3d> antennas_of(const CsiRoomParams& params) {
  std::vector<Eigen::Vector3d> antennas;
  for (int a = 0; a < params.antennas; ++a) {
    const double left_m = params.antenna_spacing_m * (a - (params.antennas - 1) / 2.0);
    antennas.emplace_back(params.antenna_forward_m, left_m, params.antenna_height_m);
  }
  return antennas;
}

std::vector<CsiRadio> radios_of(const CsiRoomParams& params, const TeamMotion& motion, const Rng& rng) {
  std::vector<CsiRadio> radios;
  for (std::size_t r = 0; r < motion.starts.size(); ++r)
    radios.push_back({MacAddress{kFirstAddress + r}, antennas_of(params),
                      [&motion, r](double t_s) { return lift(motion.pose_at(r, t_s)); },
                      CsiCard(params.cards, motion.end_s, rng.split(r))});
  return radios;
}

/// The packet rounds of every leg: start times and packet counters.
std::vector<std::vector<SentPacket>> rounds_of(const std::vector<DriveLeg>& legs,
                                               const CsiRoomParams& params) {
  std::vector<std::vector<SentPacket>> rounds;
  std::uint32_t counter = 0;
  const double packet_margin_s = std::min(params.packet_margin_s, params.drives.pause_s / 3);
  for (const DriveLeg& leg : legs) {
    auto& own = rounds.emplace_back();
    const double begin_s = leg.begin_s - packet_margin_s, end_s = leg.end_s + packet_margin_s;
    for (int k = 0; begin_s + k / params.packet_rate_hz < end_s; ++k)
      own.push_back({begin_s + k / params.packet_rate_hz, ++counter});
  }
  return rounds;
}

/// The packets of a leg to one of the robots at rest: part `part` of `parts` of every round.
std::vector<SentPacket> part_of(std::vector<SentPacket> rounds, std::size_t part, std::size_t parts,
                                double rate_hz) {
  const double later_s = static_cast<double>(part) / (rate_hz * static_cast<double>(parts));
  for (SentPacket& packet : rounds) packet.t_s += later_s;
  return rounds;
}

/// The packets that every card received over all legs.
std::vector<std::vector<ReceivedPacket>> exchange_all(const std::vector<CsiRadio>& radios,
                                                      const TeamMotion& motion, const CsiMedium& air,
                                                      const CsiRoomParams& params, const Rng& rng) {
  const auto rounds = rounds_of(motion.legs, params);
  const std::size_t others = radios.size() - 1;
  std::vector<ReceivedPackets> received(motion.legs.size() * others);
  parallel_for(received.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t leg = k / others, part = k % others, asker = motion.legs[leg].robot;
      const std::size_t answerer = part < asker ? part : part + 1;
      received[k] = exchange_packets(radios[asker], radios[answerer],
                                     part_of(rounds[leg], part, others, params.packet_rate_hz), air,
                                     rng.split(asker).split(answerer));
    }
  });
  std::vector<std::vector<ReceivedPacket>> by_radio(radios.size());
  const auto append = [](std::vector<ReceivedPacket>& from, std::vector<ReceivedPacket>& to) {
    std::move(from.begin(), from.end(), std::back_inserter(to));
  };
  for (std::size_t k = 0; k < received.size(); ++k) {
    const std::size_t part = k % others, asker = motion.legs[k / others].robot;
    append(received[k].by_asker, by_radio[asker]);
    append(received[k].by_answerer, by_radio[part < asker ? part : part + 1]);
  }
  return by_radio;
}

std::vector<RangeMeasurement> draw_ranges(const TeamMotion& motion, const CsiRoomParams& params,
                                          const Rng& rng) {
  std::vector<RangeMeasurement> ranges;
  for (std::size_t j = 1; j < motion.starts.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      Rng own = rng.split(j).split(i);
      for (int k = 0; k < params.ranges_per_pair; ++k) {
        const double t_s = motion.end_s * (k + own.uniform()) / params.ranges_per_pair;
        RangeMeasurement& range = ranges.emplace_back();
        range.stamp = {static_cast<std::int64_t>(t_s * kMillisecondsPerSecond) * kNanosecondsPerMillisecond};
        const double now_s = range.stamp.seconds();
        range.i.robot = RobotIndex(i);
        range.j.robot = RobotIndex(j);
        const Eigen::Vector2d offset =
            motion.pose_at(j, now_s).translation() - motion.pose_at(i, now_s).translation();
        range.range_m = std::max(0.0, own.normal(offset.norm(), params.sigma_range_m));
        range.sigma_m = params.sigma_range_m;
      }
    }
  std::stable_sort(ranges.begin(), ranges.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return ranges;
}

void append_robots(const TeamMotion& motion, const CsiRoomParams& params, const Rng& rng,
                   Simulation& simulation) {
  const auto stamps = regular_stamps(0, motion.end_s, params.odometry.odometry_rate_hz);
  for (std::size_t r = 0; r < motion.starts.size(); ++r) {
    std::vector<SE2> poses;
    for (const Stamp stamp : stamps) poses.push_back(motion.pose_at(r, stamp.seconds()));
    Robot& robot = simulation.mission.robots.emplace_back();
    robot.id = robot_id(r);
    robot.odometry = lifted(stamps, draw_dead_reckoning(poses, params.odometry, rng.split(r)).T_start_body);
    robot.odometry_noise = stated_noise(params.odometry);
    robot.lidar_range_m = params.lidar_range_m;
    simulation.truth.robots.push_back({robot.id, lifted(stamps, poses), true});
  }
}

}  // namespace

std::vector<WallSegment> walls_of(const CsiRoomParams& params) {
  const double x = params.room_x_m, y = params.room_y_m;
  std::vector<WallSegment> walls;
  const auto add = [&](const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
    walls.push_back({begin, end, params.wall_reflection, params.wall_loss_db});
  };
  add({0, 0}, {x, 0});
  add({x, 0}, {x, y});
  add({x, y}, {0, y});
  add({0, y}, {0, 0});
  if (params.inner_walls > 0) add({kInnerWallsAt[0] * x, 0}, {kInnerWallsAt[0] * x, kInnerWallReach * y});
  if (params.inner_walls > 1)
    add({kInnerWallsAt[1] * x, y}, {kInnerWallsAt[1] * x, (1 - kInnerWallReach) * y});
  return walls;
}

Simulation simulate_csi_room(const CsiRoomParams& params, std::uint64_t seed) {
  const Rng rng = Rng(seed).split("csi");
  const auto walls = walls_of(params);
  const TeamMotion motion = draw_motion(params, walls, rng.split("motion"));
  const auto radios = radios_of(params, motion, rng.split("cards"));
  const double carrier_hz = carrier_of_channel_hz(std::stoi(params.channel)).value();
  const CsiMedium air{room_paths(walls, {params.max_bounces, params.obstruction_db}),
                      CsiBand::intel5300(carrier_hz), params.cards};

  Simulation simulation;
  simulation.mission.name = "csi-" + std::to_string(seed);
  append_robots(motion, params, rng.split("odometry"), simulation);
  simulation.mission.ranges = draw_ranges(motion, params, rng.split("ranges"));
  auto received = exchange_all(radios, motion, air, params, rng.split("air"));
  for (std::size_t r = 0; r < received.size(); ++r) {
    CsiRecording& recording = simulation.mission.robots[r].csi.emplace();
    recording.address = radios[r].address;
    recording.carrier_hz = carrier_hz;
    recording.antennas_m = radios[r].antennas_m;
    if (!received[r].empty())
      recording.captures.push_back(record_as_sent(std::move(received[r]), air, rng.split("hosts").split(r)));
  }
  return simulation;
}

}  // namespace radioslam
