#include <filesystem>
#include <iostream>
#include <set>
#include <string>

#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/import/import_commands.hpp"
#include "radioslam/io/datasets/dpgo.hpp"
#include "radioslam/io/datasets/indoor_location.hpp"
#include "radioslam/io/datasets/wifi_rtt.hpp"
#include "radioslam/io/datasets/wifine.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/text/atomic_output.hpp"

namespace radioslam::cli {
namespace {

/// Writes a mission, and prints its notes.
void write_imported(MissionOutput& output, const ImportedMission& imported) {
  output.commit(imported.mission, imported.truth);
  for (const auto& notes : {imported.warnings, output.notes()})
    for (const auto& note : notes) std::cout << "note: " << note << '\n';
}

/// Writes a mission without odometry, with a note about it, and prints a summary.
void write_study(const ImportOptions& options, MissionOutput& output, const ImportedMission& imported) {
  const Mission& mission = imported.mission;
  write_imported(output, imported);
  std::size_t scans = 0;
  for (const Robot& robot : mission.robots) scans += robot.wifi.size();
  std::cout << "note: the recording has no odometry: `radioslam run` needs an odometry.tum for each robot; "
            << kOdometrySources << '\n'
            << options.output << ": " << mission.robots.size() << " robots, " << scans << " scans, "
            << mission.access_points.size() << " access points, " << mission.ranges.size() << " ranges\n";
}

void print_team(const TeamGraphFile<SE3>& file, const std::string& output) {
  std::set<std::string> robots;
  for (const TrajectorySegment& segment : file.team.segments) robots.insert(segment.robot);
  for (const auto& note : file.notes) std::cout << "note: " << note << '\n';
  std::cout << output << ": " << robots.size() << " robots, " << file.pose_ids.size() << " poses, "
            << file.team.graph.relative_poses.size() << " relative poses\n";
}

}  // namespace

void import_phone_logs(const ImportOptions& options) {
  const auto params = params_of<DeadReckoningParams>(options);
  refuse_replacing_inputs(options.output, options.sources);
  MissionOutput output(options.output, existing_of(options));
  const ImportedMission imported = import_indoor_location(only_source(options), params);
  write_imported(output, imported);
  std::cout << options.output << ": " << imported.mission.robots.size() << " robots, "
            << imported.mission.access_points.size() << " access points\n";
}

void import_wifine_trajectories(const ImportOptions& options) {
  refuse_replacing_inputs(options.output, options.sources);
  MissionOutput output(options.output, existing_of(options));
  write_study(options, output, import_wifine(only_source(options)));
}

void import_rtt_walk(const ImportOptions& options) {
  const auto params = params_of<WifiRttParams>(options);
  refuse_replacing_inputs(options.output, options.sources);
  MissionOutput output(options.output, existing_of(options));
  write_study(options, output, import_wifi_rtt(only_source(options), params));
}

void import_dpgo_tables(const ImportOptions& options) {
  refuse_replacing_inputs(options.output, options.sources);
  const auto read = [&] { return import_dpgo({options.sources.begin(), options.sources.end()}); };
  if (std::filesystem::path(options.output).extension() == ".g2o") {
    OutputFile output(options.output);
    const auto file = read();
    output.commit(format_g2o(with_ids(file.team.graph, file.pose_ids, {})));
    print_team(file, options.output);
  } else {
    MissionOutput output(options.output, existing_of(options));
    const auto file = read();
    const ImportedMission imported = mission_of_team(file, options.sources.front());
    write_imported(output, imported);
    print_team(file, options.output);
  }
}

}  // namespace radioslam::cli
