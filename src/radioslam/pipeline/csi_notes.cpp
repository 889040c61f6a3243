#include "radioslam/pipeline/csi_notes.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "radioslam/pipeline/csi_captures.hpp"

namespace radioslam {
namespace {

std::string plural(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

}  // namespace

std::string explain(NoTwoWay reason) {
  switch (reason) {
    case NoTwoWay::kOtherSubcarriers:
      return "the two ends measured other subcarriers";
    case NoTwoWay::kIncoherent:
      return "the other end's packets do not answer these, or too slowly: their phases do not agree";
    case NoTwoWay::kTooFewExchanges:
      break;
  }
  return "fewer than three packets were answered";
}

std::string explain(NoArrival reason) {
  switch (reason) {
    case NoArrival::kNoMotion:
      return "the antenna hardly moved";
    case NoArrival::kNoOdometry:
      return "there is no odometry at the packets' times";
    case NoArrival::kTooWide:
      return "the way is wider than csi.most_extent_m";
    case NoArrival::kSilent:
      return "the channel is zero throughout";
    case NoArrival::kTooFewPackets:
      break;
  }
  return "too few packets";
}

void note_what_is_missing(const Mission& mission, const Robot& robot, const CsiCapture& capture,
                          std::vector<std::string>& notes) {
  if (carrier_hz_of(*robot.csi, capture) == 0)
    notes.push_back("robot " + robot.id +
                    "'s captures took no part: neither they nor mission.yaml tell the channel");
  if (!robot.csi->address)
    notes.push_back("what others heard of robot " + robot.id +
                    " took no part: mission.yaml has no mac of its card");
  std::size_t unknown = 0;
  for (const CsiPacket& packet : capture.packets) {
    const auto sent = [&](const Robot& other) {
      return other.csi && other.csi->address && packet.sender == other.csi->address;
    };
    if (std::none_of(mission.robots.begin(), mission.robots.end(), sent)) ++unknown;
  }
  if (unknown > 0)
    notes.push_back(plural(unknown, "packet") + " of robot " + robot.id +
                    "'s captures took no part: no robot's card has the mac of their sender");
}

std::string note_of_clock(const std::string& robot, const ClockOffset& clock) {
  std::ostringstream note;
  note << std::fixed << std::setprecision(3) << "robot " << robot << "'s captures were moved by "
       << clock.offset_s << " s to its odometry's clock (sigma " << clock.sigma_s << " s)";
  return note.str();
}

void note_refusals(const Mission& mission, const CsiRefusals& refusals, std::vector<std::string>& notes) {
  for (const auto& [what, count] : refusals) {
    const auto& [receiver, transmitter, reason] = what;
    notes.push_back("robot " + mission.robots[receiver].id + " did not measure where it heard " +
                    mission.robots[transmitter].id + " from on " + plural(count, "piece") +
                    " of its way: " + reason);
  }
}

}  // namespace radioslam
