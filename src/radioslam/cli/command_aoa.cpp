// radioslam aoa: from which directions a radio heard another, from captured channel state information.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/cli/command_options.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/output_apart.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/csi_capture.hpp"
#include "radioslam/io/mac_address.hpp"
#include "radioslam/io/numbers.hpp"
#include "radioslam/io/tum.hpp"
#include "radioslam/mission/wifi_channel.hpp"
#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/radio/capture_power.hpp"
#include "radioslam/radio/clock_offset.hpp"

namespace radioslam::cli {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kLongestClock_s = 4e9;  // offsets of stamps since 1970 to any other clock; fit their 64 bits

struct AoaOptions {
  std::string capture, reverse, transmitter, trajectory, output, clock_offset = "0";
  std::vector<std::string> levers;
  std::optional<int> channel;
  std::optional<double> begin_s, end_s;
  ParameterOptions parameters;
  bool json = false;
};

/// Channels, and how strong the packets were that they come from.
struct Heard {
  ChannelTrack track;
  CapturePower heard;
  std::optional<CapturePower> answers;
};

/// A direction in the body frame at the estimate's stamp, beside the peak in the trajectory's.
struct FramedPeak {
  ArrivalDirection body;
  std::optional<ArrivalDirection> body_mirror;
  const ArrivalPeak* peak;
};

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

/// Whose packets are measured: the one asked for, or the only sender there is.
std::optional<MacAddress> transmitter_of(const AoaOptions& options, const CsiCapture& capture) {
  std::set<MacAddress> senders;
  for (const CsiPacket& packet : capture.packets)
    if (packet.sender) senders.insert(*packet.sender);
  std::string list;
  for (const MacAddress sender : senders) list += (list.empty() ? "" : ", ") + format_mac_address(sender);
  if (!options.transmitter.empty()) {
    const auto wanted = parse_mac_address(options.transmitter);
    if (!wanted)
      throw InputError("--transmitter " + options.transmitter, 0,
                       "is not an address as in 00:16:ea:00:00:01");
    if (!senders.contains(*wanted))
      throw InputError(options.capture, 0,
                       "has no packets from " + options.transmitter +
                           (list.empty() ? "; it does not tell who sent" : "; it has them from " + list));
    return wanted;
  }
  if (senders.size() > 1)
    throw InputError(options.capture, 0, "has packets from " + list + ": choose one by --transmitter");
  return senders.empty() ? std::nullopt : std::optional(*senders.begin());
}

double carrier_of(const AoaOptions& options, const CsiCapture& capture) {
  if (!options.channel) {
    if (capture.carrier_hz) return *capture.carrier_hz;
    throw InputError(options.capture, 0, "does not tell its carrier: give its WiFi channel by --channel");
  }
  if (const auto carrier_hz = carrier_of_channel_hz(*options.channel)) return *carrier_hz;
  throw InputError("--channel " + std::to_string(*options.channel), 0,
                   "is not the number of a WiFi channel (1-14 or 32-177)");
}

[[noreturn]] void refuse_answers(const AoaOptions& options, MacAddress sender, NoTwoWay reason) {
  switch (reason) {
    case NoTwoWay::kOtherSubcarriers:
      throw InputError(options.reverse, 0,
                       "measures other subcarriers than " + options.capture + ": both need one bandwidth");
    case NoTwoWay::kIncoherent:
      throw InputError(options.reverse, 0,
                       "does not answer the packets of " + format_mac_address(sender) +
                           ", or the antenna moves too far between them: from one exchange to the next the "
                           "phases do not agree");
    case NoTwoWay::kTooFewExchanges:
      break;
  }
  throw InputError(options.reverse, 0, "fewer than three of its packets answer those of " + options.capture);
}

CsiCapture read_with_notes(const std::string& path) {
  CsiCapture capture = read_csi_capture(path);
  for (const auto& warning : capture.warnings) std::cerr << "note: " << warning << '\n';
  return capture;
}

Heard by_antenna_pair(const AoaOptions& options, const CsiCapture& capture, double carrier_hz,
                      const std::vector<Eigen::Vector3d>& antennas) {
  if (antennas.size() < 2)
    throw InputError(options.capture, 0,
                     "one antenna in one direction leaves the oscillators' phases in: give the other end's "
                     "capture by --reverse, or two antennas' places by --lever twice");
  const auto sender = transmitter_of(options, capture);
  auto track = antenna_pair_track(capture, sender, carrier_hz, antennas, 0, 1);
  if (!track) throw InputError(options.capture, 0, "has no packets that two antennas heard");
  return {*std::move(track), capture_power(capture, sender), {}};
}

Heard with_answers(const AoaOptions& options, const CsiCapture& capture, double carrier_hz,
                   const std::vector<Eigen::Vector3d>& antennas, const ArrivalParams& params) {
  if (antennas.size() > 1)
    throw InputError("--lever", 0,
                     "is given twice with --reverse, which one antenna of each end takes part in");
  const auto sender = transmitter_of(options, capture);
  if (!sender) throw InputError(options.capture, 0, "does not tell who sent: its packets cannot be paired");
  const CsiCapture answers = read_with_notes(options.reverse);
  auto both = two_way_track(capture, *sender, answers, carrier_hz,
                            antennas.empty() ? Eigen::Vector3d::Zero() : antennas.front(), params.two_way);
  if (!both.track) refuse_answers(options, *sender, both.reason);
  return {*std::move(both.track), capture_power(capture, sender), capture_power(answers, std::nullopt)};
}

Heard heard_of(const AoaOptions& options, const ArrivalParams& params) {
  const CsiCapture capture = read_with_notes(options.capture);
  std::vector<Eigen::Vector3d> antennas;
  for (const auto& lever : options.levers) antennas.push_back(lever_of(lever));
  if (antennas.size() > 2) throw InputError("--lever", 0, "is given more than twice: a pair is two antennas");
  const double carrier_hz = carrier_of(options, capture);
  return options.reverse.empty() ? by_antenna_pair(options, capture, carrier_hz, antennas)
                                 : with_answers(options, capture, carrier_hz, antennas, params);
}

nlohmann::ordered_json json_of(const CapturePower& power) {
  nlohmann::ordered_json json{{"packets", power.packets}};
  if (power.received_power_dbm) json["received_power_dbm"] = *power.received_power_dbm;
  for (const auto& [modulation, snr_db] : power.effective_snr_db)
    if (std::isfinite(snr_db)) json["effective_snr_db"][modulation] = snr_db;
  return json;
}

std::vector<FramedPeak> in_body_frame(const ArrivalEstimate& estimate) {
  const Eigen::Matrix3d R_body_frame = estimate.T_frame_body.rotation().conjugate().toRotationMatrix();
  const auto turned = [&](double azimuth_rad, double elevation_rad) {
    const Eigen::Vector3d u = R_body_frame * WaveSource{azimuth_rad, elevation_rad, 0}.direction();
    return ArrivalDirection{std::atan2(u.y(), u.x()), std::asin(std::clamp(u.z(), -1.0, 1.0))};
  };
  std::vector<FramedPeak> peaks;
  for (const ArrivalPeak& peak : estimate.peaks) {
    FramedPeak framed{turned(peak.azimuth_rad, peak.elevation_rad), {}, &peak};
    if (peak.mirror) framed.body_mirror = turned(peak.mirror->azimuth_rad, peak.mirror->elevation_rad);
    peaks.push_back(framed);
  }
  return peaks;
}

nlohmann::ordered_json json_of(const ArrivalEstimate& estimate, const std::optional<ClockOffset>& clock,
                               const Heard& from) {
  nlohmann::ordered_json json{{"t_s", estimate.stamp.seconds()},
                              {"packets", estimate.packets},
                              {"explained", estimate.explained},
                              {"peaks", nlohmann::ordered_json::array()}};
  for (const FramedPeak& framed : in_body_frame(estimate)) {
    nlohmann::ordered_json peak{{"azimuth_rad", framed.body.azimuth_rad},
                                {"azimuth_trajectory_frame_rad", framed.peak->azimuth_rad},
                                {"elevation_rad", framed.body.elevation_rad},
                                {"sigma_rad", framed.peak->sigma_rad},
                                {"elevation_sigma_rad", framed.peak->elevation_sigma_rad},
                                {"power_db", framed.peak->power_db},
                                {"explained", framed.peak->explained}};
    if (framed.peak->curvature_per_m > 0) peak["distance_m"] = 1 / framed.peak->curvature_per_m;
    if (framed.body_mirror) {
      peak["mirror_azimuth_rad"] = framed.body_mirror->azimuth_rad;
      peak["mirror_azimuth_trajectory_frame_rad"] = framed.peak->mirror->azimuth_rad;
      peak["mirror_elevation_rad"] = framed.body_mirror->elevation_rad;
    }
    if (framed.peak->is_ghost) peak["ghost"] = true;
    json["peaks"].push_back(peak);
  }
  json["captures"]["heard"] = json_of(from.heard);
  if (from.answers) json["captures"]["answers"] = json_of(*from.answers);
  if (clock) json["clock_offset"] = {{"offset_s", clock->offset_s}, {"sigma_s", clock->sigma_s}};
  return json;
}

std::string profile_rows(const ArrivalEstimate& estimate) {
  std::ostringstream rows;
  rows << "azimuth_trajectory_frame_rad,power\n" << std::setprecision(9);
  const auto n = static_cast<double>(estimate.profile.size());
  for (std::size_t k = 0; k < estimate.profile.size(); ++k)
    rows << -std::numbers::pi + 2 * std::numbers::pi * static_cast<double>(k) / n << ','
         << estimate.profile[k] << '\n';
  return rows.str();
}

void print_text(const ArrivalEstimate& estimate, const std::optional<ClockOffset>& clock) {
  std::cout << estimate.packets << " packets around " << format_stamp(estimate.stamp) << " s\n"
            << "azimuth  in the trajectory's frame  elevation  sigma (deg)  power (dB)\n"
            << std::fixed;
  for (const FramedPeak& framed : in_body_frame(estimate)) {
    std::cout << std::setprecision(1) << std::setw(7) << framed.body.azimuth_rad / kDegree_rad
              << std::setw(28) << framed.peak->azimuth_rad / kDegree_rad << std::setw(11)
              << framed.body.elevation_rad / kDegree_rad << std::setw(13)
              << framed.peak->sigma_rad / kDegree_rad << std::setw(12) << framed.peak->power_db;
    if (framed.body_mirror)
      std::cout << "  or at " << framed.body_mirror->azimuth_rad / kDegree_rad << ", elevation "
                << framed.body_mirror->elevation_rad / kDegree_rad << ": the way does not tell";
    if (framed.peak->is_ghost) std::cout << "  ghost: a product of two paths";
    std::cout << '\n';
  }
  if (clock)
    std::cout << std::setprecision(3) << "clock offset " << clock->offset_s << " s, sigma " << clock->sigma_s
              << " s: "
              << "added to the capture's stamps\n";
}

std::optional<ClockOffset> clock_offset_of(const AoaOptions& options, const ChannelTrack& track,
                                           const Trajectory<SE3>& trajectory) {
  if (options.clock_offset != "estimate") {
    const auto offset_s = parse_number(options.clock_offset);
    if (!offset_s || std::abs(*offset_s) > kLongestClock_s)
      throw InputError(
          "--clock-offset " + options.clock_offset, 0,
          offset_s ? "is more than any two clocks differ by" : "is neither seconds nor 'estimate'");
    return *offset_s == 0 ? std::nullopt : std::optional(ClockOffset{*offset_s, 0});
  }
  const auto result = estimate_clock_offset(track, trajectory);
  if (result.clock) return result.clock;
  switch (result.reason) {
    case NoClockOffset::kNotTwoWay:
      throw InputError("--clock-offset estimate", 0,
                       "needs packets both ways: give the other end's by --reverse");
    case NoClockOffset::kConstantSpeed:
      throw InputError("--clock-offset estimate", 0,
                       "the speed changes too little to tell: the antenna would have to stop or start");
    case NoClockOffset::kUncovered:
      break;
  }
  throw InputError("--clock-offset estimate", 0,
                   options.trajectory + " covers too few of the packets with a second to either side");
}

[[noreturn]] void refuse(const AoaOptions& options, NoArrival reason) {
  switch (reason) {
    case NoArrival::kNoOdometry:
      throw InputError(options.trajectory, 0, "has no poses at the times of " + options.capture);
    case NoArrival::kNoMotion:
      throw InputError(options.trajectory, 0, "hardly moves: one place tells no direction");
    case NoArrival::kTooWide:
      throw InputError(options.trajectory, 0,
                       "goes further than most_extent_m: choose a part of it by --begin and --end");
    case NoArrival::kSilent:
      throw InputError(options.capture, 0, "measured a channel of zeros throughout");
    case NoArrival::kTooFewPackets:
      break;
  }
  throw InputError(options.capture, 0, "has too few packets while the antenna moves");
}

/// The first and the last stamp to be measured.
std::pair<Stamp, Stamp> chosen_times(const AoaOptions& options, const ChannelTrack& track) {
  Stamp begin = track.stamps.front(), end = track.stamps.back();
  if (options.begin_s) begin = std::max(begin, Stamp::from_seconds(*options.begin_s));
  if (options.end_s) end = std::min(end, Stamp::from_seconds(*options.end_s));
  if (end < begin)
    throw InputError(options.capture, 0,
                     "has no packets between --begin and --end: it has them from " +
                         format_stamp(track.stamps.front()) + " to " + format_stamp(track.stamps.back()) +
                         " s");
  return {begin, end};
}

void measure(const AoaOptions& options) {
  refuse_replacing_inputs(options.output, {options.capture, options.reverse, options.trajectory});
  const auto params = with_settings(ArrivalParams{},
                                    collect_settings(options.parameters.config_path, options.parameters.set));
  const auto trajectory = read_tum(read_text(options.trajectory));
  Heard from = heard_of(options, params);
  ChannelTrack& track = from.track;
  const auto clock = clock_offset_of(options, track, trajectory);
  if (clock) track = shifted(std::move(track), clock->offset_s);
  const auto [begin, end] = chosen_times(options, track);
  const auto result = estimate_arrival(track, trajectory, begin, end, params);
  if (!result.estimate) refuse(options, result.reason);
  if (!options.output.empty()) OutputFile(options.output).commit(profile_rows(*result.estimate));
  if (options.json)
    std::cout << json_of(*result.estimate, clock, from).dump() << '\n';
  else
    print_text(*result.estimate, clock);
}

}  // namespace

void add_aoa(CLI::App& program) {
  const auto options = std::make_shared<AoaOptions>();
  auto* command = program.add_subcommand("aoa", "Measure angles of arrival from channel state information");
  command
      ->add_option("CAPTURE", options->capture,
                   "What the moving robot's card heard: Intel 5300 .dat, ESP32 .csv or Nexmon .pcap")
      ->required();
  command->add_option("--trajectory", options->trajectory, "Its body poses, in the TUM format")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--reverse", options->reverse, "What the other end heard of it: offsets cancel in pairs")
      ->type_name("CAPTURE");
  command->add_option("--transmitter", options->transmitter, "Whose packets to measure, of several")
      ->type_name("MAC");
  command
      ->add_option("--lever", options->levers,
                   "The antenna in the body frame, metres; default 0,0,0. Twice: the first two antennas, "
                   "measured against each other")
      ->type_name("x,y,z")
      ->expected(1)
      ->take_all();
  command->add_option("--channel", options->channel, "WiFi channel, where the capture does not tell")
      ->type_name("N");
  command
      ->add_option("--clock-offset", options->clock_offset,
                   "Seconds to add to the capture's stamps, or 'estimate'; default 0")
      ->type_name("S");
  command->add_option("--begin", options->begin_s, "Measure packets from this stamp on, of those to the end")
      ->check(CLI::Range(-kLongestClock_s, kLongestClock_s))
      ->type_name("S");
  command->add_option("--end", options->end_s, "Measure packets up to this stamp")
      ->check(CLI::Range(-kLongestClock_s, kLongestClock_s))
      ->type_name("S");
  command->add_option("-o,--output", options->output, "The profile over azimuth to write, as CSV")
      ->type_name("PROFILE.csv");
  add_parameter_options(*command, options->parameters);
  add_json_option(*command, options->json);
  add_threads_option(*command);
  command->footer(
      "Directions point to the transmitter from the mean place of the antenna, counter-clockwise.\n"
      "`radioslam parameters aoa` lists what --set can change.\n\n"
      "Example: a robot drove an arc of a metre, and another answered\n"
      "  radioslam aoa rx.dat --reverse tx.dat --transmitter 00:21:6a:3f:17:5a --trajectory rx.tum "
      "--channel 108");
  command->callback([options] { measure(*options); });
}

}  // namespace radioslam::cli
