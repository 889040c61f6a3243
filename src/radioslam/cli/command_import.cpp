// radioslam import: other people's recordings become a mission folder, or a table for one.
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/cli/command_options.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/indoor_location.hpp"
#include "radioslam/io/iw_ftm.hpp"
#include "radioslam/io/mission_folder.hpp"
#include "radioslam/io/team_tables.hpp"
#include "radioslam/io/usable_id.hpp"

namespace radioslam::cli {
namespace {

constexpr const char* kIndoorLocation = "indoor-location";
constexpr const char* kIwFtm = "iw-ftm";

struct ImportOptions {
  std::string kind;
  std::string source;
  std::string output;
  std::string robot;
  std::vector<std::string> names;
  ParameterOptions parameters;
};

template <class Params>
Params params_of(const ImportOptions& options) {
  return with_settings(Params{}, collect_settings(options.parameters.config_path, options.parameters.set));
}

void import_walks(const ImportOptions& options) {
  const auto params = params_of<DeadReckoningParams>(options);
  if (!options.robot.empty() || !options.names.empty())
    throw InputError("import indoor-location", 0, "--robot and --name are for iw-ftm");
  OutputFolder output(options.output, kMissionFolder);
  const ImportedMission imported = import_indoor_location(options.source, params);
  write_mission(output.path(), imported.mission, imported.truth);
  output.commit();
  for (const auto& warning : imported.warnings) std::cout << "note: " << warning << '\n';
  std::cout << options.output << ": " << imported.mission.robots.size() << " robots, "
            << imported.mission.access_points.size() << " access points\n";
}

void check_id(const std::string& option, const std::string& id) {
  if (!is_usable_id(id))
    throw InputError(option, 0, "'" + id + "' cannot be the name of a robot or an anchor");
}

/// What each --name BSSID=ID calls a radio.
std::map<std::string, std::string> names_of(const ImportOptions& options) {
  std::map<std::string, std::string> names;
  for (const std::string& option : options.names) {
    const std::size_t equals = option.find('=');
    if (equals == std::string::npos) throw InputError("--name " + option, 0, "BSSID=ID is expected");
    std::string bssid = option.substr(0, equals);
    for (char& c : bssid)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    check_id("--name " + option, option.substr(equals + 1));
    if (option.substr(equals + 1) == options.robot)
      throw InputError("--name " + option, 0, "the robot measures no distance to itself");
    if (!names.emplace(bssid, option.substr(equals + 1)).second)
      throw InputError("--name " + option, 0, "this BSSID has a name already");
  }
  return names;
}

/// The robot's ranges as a mission's; every radio stands as an anchor, which in the table is a name alone.
Mission mission_of(const IwFtmLog& log, const ImportOptions& options) {
  const auto names = names_of(options);
  Mission mission;
  mission.robots.emplace_back().id = options.robot;
  std::map<std::string, AnchorIndex> anchors;
  for (const FtmRange& range : log.ranges) {
    const auto named = names.find(range.bssid);
    const std::string& id = named == names.end() ? range.bssid : named->second;
    const auto [anchor, is_new] = anchors.try_emplace(id, AnchorIndex(mission.anchors.size()));
    if (is_new) mission.anchors.push_back({id, std::nullopt, 0});
    RangeMeasurement measurement{range.stamp, {}, {}, range.range_m, range.sigma_m};
    measurement.i.robot = RobotIndex(std::size_t{0});
    measurement.j.anchor = anchor->second;
    mission.ranges.push_back(measurement);
  }
  return mission;
}

void note(std::size_t count, const char* what) {
  if (count > 0) std::cout << "note: " << count << ' ' << what << '\n';
}

void import_ranges(const ImportOptions& options) {
  const auto params = params_of<IwFtmParams>(options);
  if (options.robot.empty()) throw InputError("import iw-ftm", 0, "--robot says whose ranges they are");
  check_id("--robot " + options.robot, options.robot);
  OutputFile output(options.output);
  const IwFtmLog log = read_iw_ftm(read_text(options.source), params);
  const Mission mission = mission_of(log, options);
  if (mission.ranges.empty())
    throw InputError(options.source, 0,
                     "none of the " + std::to_string(log.failed + log.implausible + log.timeless) +
                         " measurements gave a distance with a time");
  output.commit(format_ranges(mission));
  note(log.failed, "measurements failed");
  note(log.implausible, "distances are implausible and left out");
  note(log.timeless, "distances have no time and are left out");
  note(log.disagreeing, "have a DIST_AVG that is not the distance of RTT_AVG, which is taken");
  std::cout << options.output << ": " << mission.ranges.size() << " ranges of " << options.robot << " to";
  for (const Anchor& anchor : mission.anchors) std::cout << ' ' << anchor.id;
  std::cout << '\n';
}

void import_recordings(const ImportOptions& options) {
  if (options.kind == kIndoorLocation) return import_walks(options);
  if (options.kind == kIwFtm) return import_ranges(options);
  throw InputError("import " + options.kind, 0,
                   "there is no such kind of source" + did_you_mean(options.kind, {kIndoorLocation, kIwFtm}));
}

}  // namespace

void add_import(CLI::App& program) {
  const auto options = std::make_shared<ImportOptions>();
  auto* command =
      program.add_subcommand("import", "Turn other people's recordings into a mission, or a table of one");
  command
      ->add_option("KIND", options->kind,
                   "indoor-location: phone logs of walks on one floor, into a mission;\n"
                   "iw-ftm: what `iw dev wlan0 measurement ftm_request` or `iw event -t` printed, into a "
                   "ranges.csv")
      ->required();
  command->add_option("SOURCE", options->source, "A log, or (walks) a folder that holds logs at any depth")
      ->required();
  add_output_option(*command, options->output,
                    "The mission folder, or the ranges.csv, to write; replaced if there is one");
  command->add_option("--robot", options->robot, "iw-ftm: the robot that measured")->type_name("ID");
  command
      ->add_option("--name", options->names,
                   "iw-ftm: call this radio so, an anchor or another robot; its BSSID by default")
      ->type_name("BSSID=ID")
      ->expected(1)
      ->take_all();
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->footer(
      "`radioslam parameters import` lists what --set can change for walks, `radioslam parameters iw-ftm` "
      "for\n"
      "ranges. A mission takes a robot's ranges in radio/ranges.csv; each radio that is no robot needs a row "
      "in\n"
      "radio/anchors.csv, empty coordinates where its place is unknown.\n\n"
      "Example: the walks of one floor; a robot's distances to two access points\n"
      "  radioslam import indoor-location site1/F1 -o walks\n"
      "  radioslam import iw-ftm ftm.txt --robot a --name 02:00:00:00:01:00=door -o ranges.csv");
  command->callback([options] { import_recordings(*options); });
}

}  // namespace radioslam::cli
