// radioslam aoa: from which directions a radio heard another, from captured channel state information.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "radioslam/cli/arrival_output.hpp"
#include "radioslam/cli/command_options.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/heard_channels.hpp"
#include "radioslam/cli/output_apart.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/numbers.hpp"
#include "radioslam/io/tum.hpp"
#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/radio/clock_offset.hpp"

namespace radioslam::cli {
namespace {

constexpr double kLongestClock_s = 4e9;  // offsets of stamps since 1970 to any other clock; fit their 64 bits

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
      throw InputError(options.trajectory, 0, "has no poses at the times of " + options.captures.capture);
    case NoArrival::kNoMotion:
      throw InputError(options.trajectory, 0, "hardly moves: one place tells no direction");
    case NoArrival::kTooWide:
      throw InputError(options.trajectory, 0,
                       "goes further than most_extent_m: choose a part of it by --begin and --end");
    case NoArrival::kSilent:
      throw InputError(options.captures.capture, 0, "measured a channel of zeros throughout");
    case NoArrival::kTooFewPackets:
      break;
  }
  throw InputError(options.captures.capture, 0, "has too few packets while the antenna moves");
}

/// The first and the last stamp to be measured.
std::pair<Stamp, Stamp> chosen_times(const AoaOptions& options, const ChannelTrack& track) {
  Stamp begin = track.stamps.front(), end = track.stamps.back();
  if (options.begin_s) begin = std::max(begin, Stamp::from_seconds(*options.begin_s));
  if (options.end_s) end = std::min(end, Stamp::from_seconds(*options.end_s));
  if (end < begin)
    throw InputError(options.captures.capture, 0,
                     "has no packets between --begin and --end: it has them from " +
                         format_stamp(track.stamps.front()) + " to " + format_stamp(track.stamps.back()) +
                         " s");
  return {begin, end};
}

void measure(const AoaOptions& options) {
  refuse_replacing_inputs(options.output,
                          {options.captures.capture, options.captures.reverse, options.trajectory});
  const auto params = with_settings(ArrivalParams{},
                                    collect_settings(options.parameters.config_path, options.parameters.set));
  const auto trajectory = read_tum(read_text(options.trajectory));
  HeardChannels from = read_channels(options.captures, params);
  ChannelTrack& track = from.track;
  const auto clock = clock_offset_of(options, track, trajectory);
  if (clock) track = shifted(std::move(track), clock->offset_s);
  const auto [begin, end] = chosen_times(options, track);
  const auto result = estimate_arrival(track, trajectory, begin, end, params);
  if (!result.estimate) refuse(options, result.reason);
  if (!options.output.empty()) OutputFile(options.output).commit(profile_rows(*result.estimate));
  if (options.json)
    std::cout << arrival_json(*result.estimate, clock, from).dump() << '\n';
  else
    print_arrival(*result.estimate, clock);
}

}  // namespace

void add_aoa(CLI::App& program) {
  const auto options = std::make_shared<AoaOptions>();
  auto* command = program.add_subcommand("aoa", "Measure angles of arrival from channel state information");
  command
      ->add_option("CAPTURE", options->captures.capture,
                   "What the moving robot's card heard: Intel 5300 .dat, ESP32 .csv or Nexmon .pcap")
      ->required();
  command->add_option("--trajectory", options->trajectory, "Its body poses, in the TUM format")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--reverse", options->captures.reverse,
                   "What the other end heard of it: offsets cancel in pairs")
      ->type_name("CAPTURE");
  command->add_option("--transmitter", options->captures.transmitter, "Whose packets to measure, of several")
      ->type_name("MAC");
  command
      ->add_option("--lever", options->captures.levers,
                   "The antenna in the body frame, metres; default 0,0,0. Twice: the first two antennas, "
                   "measured against each other")
      ->type_name("x,y,z")
      ->expected(1)
      ->take_all();
  command->add_option("--channel", options->captures.channel, "WiFi channel, where the capture does not tell")
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
