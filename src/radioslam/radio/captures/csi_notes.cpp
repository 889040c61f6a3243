#include "radioslam/radio/captures/csi_notes.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "radioslam/radio/captures/csi_tracks.hpp"

namespace radioslam {
namespace {

std::string plural(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

}  // namespace

std::string explain(TwoWayFailure reason) {
  switch (reason) {
    case TwoWayFailure::kOtherSubcarriers:
      return "the two ends measured different subcarriers";
    case TwoWayFailure::kIncoherent:
      return "phases of packets and replies do not agree: replies to another robot, or too far apart in time";
    case TwoWayFailure::kTooFewExchanges:
      break;
  }
  return "fewer than three packets have a captured reply";
}

std::string explain(AoaFailure reason) {
  switch (reason) {
    case AoaFailure::kNoMotion:
      return "the antenna hardly moved";
    case AoaFailure::kNoOdometry:
      return "no odometry at the packets' stamps";
    case AoaFailure::kTooWide:
      return "the aperture is larger than csi.max_aperture_m";
    case AoaFailure::kZeroChannel:
      return "all channels are zero";
    case AoaFailure::kTooFewPackets:
      break;
  }
  return "too few packets";
}

void note_missing_csi(const Mission& mission, const Robot& robot, const CsiCapture& capture,
                      std::vector<std::string>& notes) {
  if (carrier_hz_of(*robot.csi, capture) == 0)
    notes.push_back("robot " + robot.id +
                    "'s CSI captures were ignored: neither they nor mission.yaml give the WiFi channel");
  if (!robot.csi->address)
    notes.push_back("packets sent by robot " + robot.id +
                    " were ignored: mission.yaml has no mac for its card");
  std::size_t unknown = 0;
  for (const CsiPacket& packet : capture.packets) {
    const auto sent = [&](const Robot& other) {
      return other.csi && other.csi->address && packet.sender == other.csi->address;
    };
    if (std::none_of(mission.robots.begin(), mission.robots.end(), sent)) ++unknown;
  }
  if (unknown > 0)
    notes.push_back(plural(unknown, "packet") + " of robot " + robot.id +
                    "'s CSI captures were ignored: their sender's mac belongs to no robot");
}

std::string note_of_clock(const std::string& robot, const ClockOffset& clock) {
  std::ostringstream note;
  note << std::fixed << std::setprecision(3) << "robot " << robot << "'s CSI captures were shifted by "
       << clock.offset_s << " s to match its odometry's clock (sigma " << clock.sigma_s << " s)";
  return note.str();
}

void note_refusals(const Mission& mission, const CsiRefusals& refusals, std::vector<std::string>& notes) {
  for (const auto& [what, count] : refusals) {
    const auto& [receiver, transmitter, reason] = what;
    notes.push_back("robot " + mission.robots[receiver].id + " measured no angle of arrival of robot " +
                    mission.robots[transmitter].id + " in " + plural(count, "window") + ": " + reason);
  }
}

}  // namespace radioslam
