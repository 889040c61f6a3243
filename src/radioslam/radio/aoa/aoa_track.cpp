#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"

namespace radioslam {

TwoWayTrack two_way_track(const CsiCapture& receiver, MacAddress sender, const CsiCapture& answers,
                          double carrier_hz, const Eigen::Vector3d& antenna_m, const TwoWayParams& params) {
  auto two_way = two_way_channel(receiver, sender, answers, params);
  if (!two_way.channel) return {std::nullopt, two_way.reason};
  ChannelTrack track;
  track.stamps = std::move(two_way.channel->stamps);
  track.channel = std::move(two_way.channel->product);
  track.subcarrier_hz = receiver.subcarrier_hz;
  track.carrier_hz = carrier_hz;
  track.is_two_way = true;
  track.lever_arm_m = antenna_m;
  return {std::move(track), {}};
}

std::optional<ChannelTrack> antenna_pair_track(const CsiCapture& receiver, std::optional<MacAddress> sender,
                                               double carrier_hz,
                                               const std::vector<Eigen::Vector3d>& antennas_m, int first,
                                               int second) {
  const auto last = static_cast<std::size_t>(std::max(first, second));
  RADIOSLAM_CHECK(std::min(first, second) >= 0 && last < antennas_m.size(), "antennas of the pair");
  std::vector<const CsiPacket*> packets;
  for (const CsiPacket& packet : receiver.packets)
    if (packet.antennas > static_cast<int>(last) && (!sender || packet.sender == sender))
      packets.push_back(&packet);
  std::stable_sort(packets.begin(), packets.end(),
                   [](const CsiPacket* a, const CsiPacket* b) { return a->stamp < b->stamp; });
  packets.erase(std::unique(packets.begin(), packets.end(),
                            [](const CsiPacket* a, const CsiPacket* b) { return a->stamp == b->stamp; }),
                packets.end());
  if (packets.empty()) return std::nullopt;
  ChannelTrack track;
  track.subcarrier_hz = receiver.subcarrier_hz;
  track.carrier_hz = carrier_hz;
  track.lever_arm_m =
      antennas_m[static_cast<std::size_t>(first)] - antennas_m[static_cast<std::size_t>(second)];
  track.channel.resize(std::ssize(packets), std::ssize(receiver.subcarrier_hz));
  for (Eigen::Index k = 0; k < track.channel.rows(); ++k) {
    const CsiPacket& packet = *packets[static_cast<std::size_t>(k)];
    track.stamps.push_back(packet.stamp);
    track.channel.row(k) = packet.channel.row(first).cast<std::complex<double>>().cwiseProduct(
        packet.channel.row(second).conjugate().cast<std::complex<double>>());
  }
  return track;
}

}  // namespace radioslam
