// radioslam import: other people's recordings become a mission folder, or a table for one.
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/cli/command_options.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/import_lidar.hpp"
#include "radioslam/cli/import_options.hpp"
#include "radioslam/cli/import_wifi.hpp"
#include "radioslam/cli/output_apart.hpp"
#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/indoor_location.hpp"
#include "radioslam/io/iw_ftm.hpp"
#include "radioslam/io/mission_folder.hpp"
#include "radioslam/io/team_tables.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/io/wifi_rtt.hpp"
#include "radioslam/io/wifine.hpp"

namespace radioslam::cli {
namespace {

void import_walks(const ImportOptions& options) {
  const auto params = params_of<DeadReckoningParams>(options);
  refuse_replacing_inputs(options.output, options.sources);
  OutputFolder output(options.output, kMissionFolder);
  const ImportedMission imported = import_indoor_location(only_source(options), params);
  write_mission(output.path(), imported.mission, imported.truth);
  output.commit();
  for (const auto& warning : imported.warnings) std::cout << "note: " << warning << '\n';
  std::cout << options.output << ": " << imported.mission.robots.size() << " robots, "
            << imported.mission.access_points.size() << " access points\n";
}

/// Recordings without odometry: what there is, and a line that says so.
void write_study(const ImportOptions& options, OutputFolder& output, const ImportedMission& imported) {
  const Mission& mission = imported.mission;
  write_mission(output.path(), mission, imported.truth);
  output.commit();
  std::size_t scans = 0;
  for (const Robot& robot : mission.robots) scans += robot.wifi.size();
  for (const auto& warning : imported.warnings) std::cout << "note: " << warning << '\n';
  std::cout << "note: nobody recorded odometry: `radioslam run` needs an odometry.tum of each robot\n"
            << options.output << ": " << mission.robots.size() << " robots, " << scans << " scans, "
            << mission.access_points.size() << " access points, " << mission.ranges.size() << " ranges\n";
}

void import_wifine_walks(const ImportOptions& options) {
  refuse_replacing_inputs(options.output, options.sources);
  OutputFolder output(options.output, kMissionFolder);
  write_study(options, output, import_wifine(only_source(options)));
}

void import_rtt_walk(const ImportOptions& options) {
  const auto params = params_of<WifiRttParams>(options);
  refuse_replacing_inputs(options.output, options.sources);
  OutputFolder output(options.output, kMissionFolder);
  write_study(options, output, import_wifi_rtt(only_source(options), params));
}

/// What each --name BSSID=ID calls a radio.
std::map<std::string, std::string> names_of(const ImportOptions& options) {
  std::map<std::string, std::string> names;
  for (const std::string& option : options.names) {
    const std::size_t equals = option.find('=');
    if (equals == std::string::npos) throw InputError("--name " + option, 0, "BSSID=ID is expected");
    const std::string bssid = lower_case(option.substr(0, equals));
    check_import_id("--name " + option, option.substr(equals + 1));
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
  check_import_id("--robot " + options.robot, options.robot);
  refuse_replacing_inputs(options.output, options.sources);
  OutputFile output(options.output);
  const IwFtmLog log = read_iw_ftm(read_text(only_source(options)), params);
  const Mission mission = mission_of(log, options);
  if (mission.ranges.empty())
    throw InputError(only_source(options), 0,
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

/// An option that not every kind takes.
enum class Option { kRobot, kRobots, kName, kFields, kTime, kPoses, kTopics, kParameters };

/// One kind of source.
struct ImportKind {
  const char* name;
  void (*import)(const ImportOptions&);
  std::vector<Option> options;
};

const std::vector<ImportKind>& import_kinds() {
  static const std::vector<ImportKind> kinds{
      {"indoor-location", import_walks, {Option::kParameters}},
      {"iw-ftm", import_ranges, {Option::kRobot, Option::kName, Option::kParameters}},
      {"iw", import_printed_scans, {Option::kRobot, Option::kTime, Option::kParameters}},
      {"iwlist", import_printed_scans, {Option::kRobot, Option::kTime, Option::kParameters}},
      {"nmcli", import_printed_scans, {Option::kRobot, Option::kTime, Option::kFields, Option::kParameters}},
      {"airodump", import_airodump, {Option::kRobot, Option::kParameters}},
      {"pcap", import_wifi_captures, {Option::kRobot, Option::kParameters}},
      {"wifine", import_wifine_walks, {}},
      {"wifi-rtt", import_rtt_walk, {Option::kParameters}},
      {"carmen", import_carmen_logs, {Option::kRobots, Option::kParameters}},
      {"kitti", import_kitti_drives, {Option::kRobots, Option::kPoses}},
      {"rosbag", import_ros_recordings, {Option::kRobots, Option::kTopics}},
  };
  return kinds;
}

void refuse_unless(bool is_fine, const ImportOptions& options, const char* option) {
  if (!is_fine) throw InputError("import " + options.kind, 0, std::string("takes no ") + option);
}

void check_options(const ImportOptions& options, const ImportKind& kind) {
  const auto takes = [&](Option option) {
    return std::find(kind.options.begin(), kind.options.end(), option) != kind.options.end();
  };
  refuse_unless(options.robots.empty() || takes(Option::kRobot) || takes(Option::kRobots), options,
                "--robot");
  refuse_unless(options.robots.size() <= 1 || takes(Option::kRobots), options, "second --robot");
  refuse_unless(options.names.empty() || takes(Option::kName), options, "--name");
  refuse_unless(options.fields.empty() || takes(Option::kFields), options, "--fields");
  refuse_unless(options.poses.empty() || takes(Option::kPoses), options, "--poses");
  const bool has_topics = options.list || !options.odometry.empty() || !options.scans.empty() ||
                          !options.imu.empty() || !options.gnss.empty() || !options.truth.empty();
  refuse_unless(!has_topics || takes(Option::kTopics), options, "topics of ROS");
  refuse_unless(options.time.empty() || takes(Option::kTime), options, "--time");
  const bool has_settings = !options.parameters.set.empty() || !options.parameters.config_path.empty();
  refuse_unless(!has_settings || takes(Option::kParameters), options, "parameters");
  refuse_unless(!options.file_times || takes(Option::kTime), options, "--file-times");
}

void import_recordings(ImportOptions options) {
  std::replace(options.kind.begin(), options.kind.end(), '_', '-');
  if (!options.robots.empty()) options.robot = options.robots.front();
  if (options.output.empty() && !options.list) throw CLI::RequiredError("--output");
  std::vector<std::string> names;
  for (const ImportKind& kind : import_kinds()) {
    names.emplace_back(kind.name);
    if (options.kind != kind.name) continue;
    check_options(options, kind);
    return kind.import(options);
  }
  throw InputError("import " + options.kind, 0,
                   "there is no such kind of source" + did_you_mean(options.kind, names));
}

}  // namespace

void add_import(CLI::App& program) {
  const auto options = std::make_shared<ImportOptions>();
  auto* command =
      program.add_subcommand("import", "Turn other people's recordings into a mission, or a table of one");
  add_import_options(*command, *options);
  command->callback([options] { import_recordings(*options); });
}

}  // namespace radioslam::cli
