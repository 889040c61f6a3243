#include "radioslam/cli/commands/csi_channels.hpp"

#include <iostream>
#include <set>
#include <sstream>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/csi/csi_capture.hpp"
#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam::cli {
namespace {

Eigen::Vector3d lever_of(const std::string& text) {
  Eigen::Vector3d lever;
  std::istringstream fields(text);
  std::string field;
  int count = 0;
  for (; std::getline(fields, field, ','); ++count) {
    const auto number = parse_number(field);
    if (!number || count > 2) throw InputError("--lever " + text, 0, "is not x,y,z in metres");
    lever[count] = *number;
  }
  if (count != 3) throw InputError("--lever " + text, 0, "is not x,y,z in metres");
  return lever;
}

/// The sender whose packets to use: the one asked for, or the only one in the capture.
std::optional<MacAddress> transmitter_of(const AoaCaptures& asked, const CsiCapture& capture) {
  std::set<MacAddress> senders;
  for (const CsiPacket& packet : capture.packets)
    if (packet.sender) senders.insert(*packet.sender);
  std::string list;
  for (const MacAddress sender : senders) list += (list.empty() ? "" : ", ") + format_mac_address(sender);
  if (!asked.transmitter.empty()) {
    const auto wanted = parse_mac_address(asked.transmitter);
    if (!wanted)
      throw InputError("--transmitter " + asked.transmitter, 0,
                       "is not a MAC address such as 00:16:ea:00:00:01");
    if (!senders.contains(*wanted))
      throw InputError(asked.capture, 0,
                       "has no packets from " + asked.transmitter +
                           (list.empty() ? "; it does not record senders" : ", only from " + list));
    return wanted;
  }
  if (senders.size() > 1)
    throw InputError(asked.capture, 0, "has packets from " + list + ": choose one with --transmitter");
  return senders.empty() ? std::nullopt : std::optional(*senders.begin());
}

double carrier_of(const AoaCaptures& asked, const CsiCapture& capture) {
  if (!asked.channel) {
    if (capture.carrier_hz) return *capture.carrier_hz;
    throw InputError(asked.capture, 0, "does not record its carrier: give its WiFi channel with --channel");
  }
  if (const auto carrier_hz = carrier_of_channel_hz(*asked.channel)) return *carrier_hz;
  throw InputError("--channel " + std::to_string(*asked.channel), 0,
                   "is not the number of a WiFi channel (1-14 or 32-177)");
}

[[noreturn]] void refuse_answers(const AoaCaptures& asked, MacAddress sender, TwoWayFailure reason) {
  switch (reason) {
    case TwoWayFailure::kOtherSubcarriers:
      throw InputError(
          asked.reverse, 0,
          "measures other subcarriers than " + asked.capture + ": both must use the same bandwidth");
    case TwoWayFailure::kIncoherent:
      throw InputError(
          asked.reverse, 0,
          "does not answer the packets of " + format_mac_address(sender) +
              ", or the antenna moves too far between packets: the phases are inconsistent from one "
              "exchange to the next");
    case TwoWayFailure::kTooFewExchanges:
      break;
  }
  throw InputError(asked.reverse, 0, "fewer than three of its packets answer those of " + asked.capture);
}

CsiCapture read_with_notes(const std::string& path) {
  CsiCapture capture = read_csi_capture(path);
  for (const auto& warning : capture.warnings) std::cerr << "note: " << warning << '\n';
  return capture;
}

CsiChannels by_antenna_pair(const AoaCaptures& asked, const CsiCapture& capture, double carrier_hz,
                            const std::vector<Eigen::Vector3d>& antennas) {
  if (antennas.size() < 2)
    throw InputError(
        asked.capture, 0,
        "the oscillators' phases do not cancel with one antenna and one direction: give the other "
        "end's capture with --reverse, or the positions of two antennas with --lever twice");
  const auto sender = transmitter_of(asked, capture);
  auto track = antenna_pair_track(capture, sender, carrier_hz, antennas, 0, 1);
  if (!track) throw InputError(asked.capture, 0, "has no packets received by two antennas");
  return {*std::move(track), capture_power(capture, sender), {}};
}

CsiChannels with_answers(const AoaCaptures& asked, const CsiCapture& capture, double carrier_hz,
                         const std::vector<Eigen::Vector3d>& antennas, const AoaParams& params) {
  if (antennas.size() > 1)
    throw InputError("--lever", 0,
                     "may be given only once with --reverse, which uses one antenna at each end");
  const auto sender = transmitter_of(asked, capture);
  if (!sender)
    throw InputError(asked.capture, 0, "does not record senders: its packets cannot be paired with answers");
  const CsiCapture answers = read_with_notes(asked.reverse);
  auto both = two_way_track(capture, *sender, answers, carrier_hz,
                            antennas.empty() ? Eigen::Vector3d::Zero() : antennas.front(), params.two_way);
  if (!both.track) refuse_answers(asked, *sender, both.reason);
  return {*std::move(both.track), capture_power(capture, sender), capture_power(answers, std::nullopt)};
}

}  // namespace

CsiChannels read_channels(const AoaCaptures& asked, const AoaParams& params) {
  const CsiCapture capture = read_with_notes(asked.capture);
  std::vector<Eigen::Vector3d> antennas;
  for (const auto& lever : asked.levers) antennas.push_back(lever_of(lever));
  if (antennas.size() > 2)
    throw InputError("--lever", 0, "may be given at most twice, for a pair of antennas");
  const double carrier_hz = carrier_of(asked, capture);
  return asked.reverse.empty() ? by_antenna_pair(asked, capture, carrier_hz, antennas)
                               : with_answers(asked, capture, carrier_hz, antennas, params);
}

}  // namespace radioslam::cli
