#include <iostream>
#include <map>
#include <string>

#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/import/import_commands.hpp"
#include "radioslam/io/mission/team_tables.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/iw_ftm.hpp"

namespace radioslam::cli {
namespace {

/// The radios' names given by --name BSSID=ID, by BSSID.
std::map<std::string, std::string> names_of(const ImportOptions& options) {
  std::map<std::string, std::string> names;
  for (const std::string& option : options.names) {
    const std::size_t equals = option.find('=');
    if (equals == std::string::npos) throw InputError("--name " + option, 0, "expected BSSID=ID");
    const std::string bssid = lower_case(option.substr(0, equals));
    check_import_id("--name " + option, option.substr(equals + 1));
    if (option.substr(equals + 1) == options.robot)
      throw InputError("--name " + option, 0, "the robot cannot measure a range to itself");
    if (!names.emplace(bssid, option.substr(equals + 1)).second)
      throw InputError("--name " + option, 0, "this BSSID already has a name");
  }
  return names;
}

/// The ranges as those of a mission, in which every radio is an anchor without a position.
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

}  // namespace

void import_ftm_ranges(const ImportOptions& options) {
  const auto params = params_of<IwFtmParams>(options);
  if (options.robot.empty())
    throw InputError("import iw-ftm", 0, "--robot is required: the robot that measured the ranges");
  check_import_id("--robot " + options.robot, options.robot);
  refuse_replacing_inputs(options.output, options.sources);
  refuse_table_of_mission(options);
  OutputFile output(options.output);
  const IwFtmLog log = read_iw_ftm(read_tool_output(only_source(options)), params);
  const Mission mission = mission_of(log, options);
  if (mission.ranges.empty())
    throw InputError(only_source(options), 0,
                     "none of the " + std::to_string(log.failed + log.implausible + log.timeless) +
                         " measurements has both a distance and a time");
  output.commit(format_ranges(mission));
  for (const std::string& warning : log.warnings) std::cout << "note: " << warning << '\n';
  note(log.failed, "measurements failed");
  note(log.implausible, "implausible distances were omitted");
  note(log.timeless, "distances without a time were omitted");
  note(log.disagreeing, "measurements have a DIST_AVG that contradicts RTT_AVG; RTT_AVG is used");
  std::cout << options.output << ": " << mission.ranges.size() << " ranges from " << options.robot << " to";
  for (const Anchor& anchor : mission.anchors) std::cout << ' ' << anchor.id;
  std::cout << '\n';
}

}  // namespace radioslam::cli
