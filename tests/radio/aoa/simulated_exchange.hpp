// Simulated CSI captures of a moving robot that sends packets and a static one that replies.
#pragma once

#include <functional>
#include <vector>

#include "radio/aoa/waves.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/sim/sensors/csi_exchange.hpp"

namespace radioslam {

/// Card errors are those of the simulated room.
struct SimulatedExchange {
  BodyAtTime motion;
  PathsBetween paths;
  Eigen::Vector3d answerer_m{30, 0, 0};
  std::vector<Eigen::Vector3d> antennas_m{{0.1, 0.05, 0}};
  CsiCardParams cards;
  double begin_s = 2, end_s = 6, packets_hz = 120;
  std::uint64_t seed = 1;

  static constexpr double kCarrier_hz = 5.54e9, kPoses_hz = 50;

  struct Captures {
    CsiCapture asker, answerer;
  };

  Captures captures() const {
    const Rng rng(seed);
    const CsiRadio asker{MacAddress{0xa}, antennas_m, motion, CsiCard(cards, end_s + 5, rng.split("asker"))};
    const Eigen::Vector3d position_m = answerer_m;
    const CsiRadio answerer{
        MacAddress{0xb},
        {Eigen::Vector3d::Zero()},
        [position_m](double /*t_s*/) { return SE3(position_m, Eigen::Quaterniond::Identity()); },
        CsiCard(cards, end_s + 5, rng.split("answerer"))};
    std::vector<SentPacket> asked;
    for (double t_s = begin_s; t_s < end_s; t_s += 1 / packets_hz)
      asked.push_back({t_s, static_cast<std::uint32_t>(asked.size())});
    const CsiMedium air{paths, CsiBand::intel5300(kCarrier_hz), cards};
    ReceivedPackets heard = exchange_packets(asker, answerer, asked, air, rng.split("exchange"));
    return {record_as_sent(std::move(heard.by_asker), air, rng.split("asker's host")),
            record_as_sent(std::move(heard.by_answerer), air, rng.split("answerer's host"))};
  }

  ChannelTrack two_way() const {
    const Captures both = captures();
    return *two_way_track(both.asker, MacAddress{0xb}, both.answerer, kCarrier_hz, antennas_m.front(), {})
                .track;
  }

  ChannelTrack antenna_pair() const {
    return *antenna_pair_track(captures().asker, MacAddress{0xb}, kCarrier_hz, antennas_m, 0, 1);
  }

  /// True poses, from two seconds before the first packet to two after the last.
  Trajectory<SE3> trajectory(double later_s = 0) const {
    std::vector<StampedPose<SE3>> poses;
    for (double t_s = begin_s - 2; t_s < end_s + 2; t_s += 1 / kPoses_hz)
      poses.push_back({Stamp::from_seconds(t_s + later_s), motion(t_s)});
    return Trajectory<SE3>(std::move(poses));
  }
};

inline AoaResult aoa_of(const ChannelTrack& track, const Trajectory<SE3>& trajectory,
                        const AoaParams& params = {}) {
  return estimate_aoa(track, trajectory, track.stamps.front(), track.stamps.back(), params);
}

/// Pose of a body that drives forward along a circle.
inline SE3 on_circle(double radius_m, double angle_rad) {
  return {radius_m * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0),
          so3_exp({0, 0, angle_rad + std::numbers::pi / 2})};
}

/// Pose on an arc of radius 0.5 m, a metre in four seconds.
inline SE3 metre_of_arc(double t_s) { return on_circle(0.5, 0.5 * (t_s - 2)); }

inline PathsBetween wave_from(double azimuth_rad, double elevation_rad = 0) {
  return plane_wave_paths({{azimuth_rad, elevation_rad, -15, 3e-8}});
}

}  // namespace radioslam
