// radioslam aoa: estimates the angles of arrival of a radio's packets from captured channel state
// information.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/aoa_output.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/csi_channels.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/radio/captures/clock_offset.hpp"

namespace radioslam::cli {
namespace {

constexpr double kMaxClock_s =
    4e9;  // exceeds Unix times, so that any clock can be mapped; fits the 64 bits of a stamp

struct AoaOptions {
  AoaCaptures captures;
  std::string trajectory, output, clock_offset = "0";
  std::optional<double> begin_s, end_s;
  ParameterOptions parameters;
  bool json = false;
};

std::optional<ClockOffset> clock_offset_of(const AoaOptions& options, const ChannelTrack& track,
                                           const Trajectory<SE3>& trajectory) {
  if (options.clock_offset != "estimate") {
    const auto offset_s = parse_number(options.clock_offset);
    if (!offset_s || std::abs(*offset_s) > kMaxClock_s)
      throw InputError(
          "--clock-offset " + options.clock_offset, 0,
          offset_s ? "is too large for an offset of two clocks" : "is neither seconds nor 'estimate'");
    return *offset_s == 0 ? std::nullopt : std::optional(ClockOffset{*offset_s, 0});
  }
  const auto result = estimate_clock_offset(track, trajectory);
  if (result.clock) return result.clock;
  switch (result.reason) {
    case ClockOffsetFailure::kNotTwoWay:
      throw InputError("--clock-offset estimate", 0,
                       "needs packets in both directions: give the other end's capture with --reverse");
    case ClockOffsetFailure::kConstantSpeed:
      throw InputError(
          "--clock-offset estimate", 0,
          "the speed changes too little: the antenna must stop or start moving during the capture");
    case ClockOffsetFailure::kUncovered:
      break;
  }
  throw InputError(
      "--clock-offset estimate", 0,
      options.trajectory + " covers too few of the packets with a margin of one second on both sides");
}

[[noreturn]] void refuse(const AoaOptions& options, AoaFailure reason) {
  switch (reason) {
    case AoaFailure::kNoOdometry:
      throw InputError(options.trajectory, 0, "has no poses at the times of " + options.captures.capture);
    case AoaFailure::kNoMotion:
      throw InputError(options.trajectory, 0,
                       "hardly moves: directions cannot be estimated from a single position");
    case AoaFailure::kTooWide:
      throw InputError(options.trajectory, 0,
                       "exceeds max_aperture_m: select a shorter segment with --begin and --end");
    case AoaFailure::kZeroChannel:
      throw InputError(options.captures.capture, 0, "contains only channels of zero");
    case AoaFailure::kTooFewPackets:
      break;
  }
  throw InputError(options.captures.capture, 0, "has too few packets while the antenna moves");
}

/// The first and the last stamp to use.
std::pair<Stamp, Stamp> chosen_times(const AoaOptions& options, const ChannelTrack& track) {
  Stamp begin = track.stamps.front(), end = track.stamps.back();
  if (options.begin_s) begin = std::max(begin, Stamp::from_seconds(*options.begin_s));
  if (options.end_s) end = std::min(end, Stamp::from_seconds(*options.end_s));
  if (end < begin)
    throw InputError(options.captures.capture, 0,
                     "has no packets between --begin and --end: its packets range from " +
                         format_stamp(track.stamps.front()) + " to " + format_stamp(track.stamps.back()) +
                         " s");
  return {begin, end};
}

void measure(const AoaOptions& options) {
  refuse_replacing_inputs(options.output,
                          {options.captures.capture, options.captures.reverse, options.trajectory});
  const auto params =
      with_settings(AoaParams{}, collect_settings(options.parameters.config_path, options.parameters.set));
  std::vector<std::string> notes;
  const auto trajectory = read_logged_tum(read_tool_output(options.trajectory), notes);
  for (const std::string& note : notes) std::cerr << "note: " << note << '\n';
  CsiChannels from = read_channels(options.captures, params);
  ChannelTrack& track = from.track;
  const auto clock = clock_offset_of(options, track, trajectory);
  if (clock) track = shifted(std::move(track), clock->offset_s);
  const auto [begin, end] = chosen_times(options, track);
  const auto result = estimate_aoa(track, trajectory, begin, end, params);
  if (!result.estimate) refuse(options, result.reason);
  if (!options.output.empty()) OutputFile(options.output).commit(profile_rows(*result.estimate));
  if (options.json)
    std::cout << aoa_json(*result.estimate, clock, from).dump() << '\n';
  else
    print_aoa(*result.estimate, clock);
}

}  // namespace

void add_aoa(CLI::App& program) {
  const auto options = std::make_shared<AoaOptions>();
  auto* command =
      program.add_subcommand("aoa", "Estimate angles of arrival from channel state information (CSI)");
  command
      ->add_option("CAPTURE", options->captures.capture,
                   "CSI capture of the moving robot: Intel 5300 .dat, ESP32 .csv or Nexmon .pcap")
      ->required();
  command->add_option("--trajectory", options->trajectory, "Body poses of the moving robot, in TUM format")
      ->required()
      ->type_name("FILE");
  command
      ->add_option(
          "--reverse", options->captures.reverse,
          "CSI capture of the other end; phase offsets of the oscillators cancel in the two-way product")
      ->type_name("CAPTURE");
  command
      ->add_option("--transmitter", options->captures.transmitter,
                   "Sender whose packets to use, if there are several")
      ->type_name("MAC");
  command
      ->add_option(
          "--lever", options->captures.levers,
          "Position of the antenna in the body frame in metres (default: 0,0,0); given twice, the two "
          "antennas whose phases are compared")
      ->type_name("x,y,z")
      ->expected(1)
      ->take_all();
  command
      ->add_option("--channel", options->captures.channel, "WiFi channel, if the capture does not record it")
      ->type_name("N");
  command
      ->add_option("--clock-offset", options->clock_offset,
                   "Seconds to add to the capture's stamps, or 'estimate' (default: 0)")
      ->type_name("S");
  command->add_option("--begin", options->begin_s, "Use packets from this stamp on")
      ->check(CLI::Range(-kMaxClock_s, kMaxClock_s))
      ->type_name("S");
  command->add_option("--end", options->end_s, "Use packets up to this stamp")
      ->check(CLI::Range(-kMaxClock_s, kMaxClock_s))
      ->type_name("S");
  command->add_option("-o,--output", options->output, "CSV file to write with the power over azimuth")
      ->type_name("PROFILE.csv");
  add_parameter_options(*command, options->parameters);
  add_json_option(*command, options->json);
  add_threads_option(*command);
  command->footer(
      "Directions point from the mean position of the antenna to the transmitter; azimuth is positive\n"
      "counter-clockwise. A trajectory on a straight line or in a plane leaves a mirror solution, which is "
      "listed\n"
      "too.\n"
      "`radioslam parameters aoa` lists the parameters for --set and --config.\n\n"
      "Example: a robot moves along an arc of one metre while another one answers its packets\n"
      "  radioslam aoa rx.dat --reverse tx.dat --transmitter 00:21:6a:3f:17:5a --trajectory rx.tum "
      "--channel 108");
  command->callback([options] { measure(*options); });
}

}  // namespace radioslam::cli
