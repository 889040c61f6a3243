// radioslam simulate: simulates a scenario and writes a mission folder with ground truth.
#include <algorithm>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "radioslam/base/suggestion.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/recorded_drive.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/sim/scenarios/scenarios.hpp"

namespace radioslam::cli {
namespace {

struct SimulateOptions {
  std::string scenario;
  std::string output;
  std::uint64_t seed = 1;
  std::optional<std::string> robots;
  std::optional<std::string> cut;
  std::string trajectory;
  std::string odometry;
  ParameterOptions parameters;
};

const Scenario& scenario_named(const std::string& name) {
  if (const Scenario* scenario = find_scenario(name)) return *scenario;
  std::vector<std::string> names;
  for (const auto& scenario : scenarios()) names.emplace_back(scenario.name);
  throw InputError("simulate " + name, 0, "unknown scenario" + did_you_mean(name, names));
}

std::vector<Setting> settings_of(const SimulateOptions& options) {
  auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  if (options.robots) settings.push_back({"robots", *options.robots, "--robots", 0});
  if (options.cut) settings.push_back({"cut", *options.cut, "--cut", 0});
  return settings;
}

ScenarioParams with_scenario_settings(const ScenarioParams& defaults, const std::vector<Setting>& settings) {
  return std::visit([&](const auto& params) { return ScenarioParams(with_settings(params, settings)); },
                    defaults);
}

RecordedDrive drive_for(const SimulateOptions& options, const ScenarioParams& params) {
  if (needs_recording(params))
    return read_drive("simulate " + options.scenario, options.trajectory, options.odometry);
  if (!options.trajectory.empty() || !options.odometry.empty())
    throw InputError("simulate " + options.scenario, 0,
                     "takes no --trajectory or --odometry: the scenario generates them");
  return {};
}

/// The numbers of robots and measurements, in words.
std::string summary(const Mission& mission) {
  std::string text = std::to_string(mission.robots.size()) + " robots";
  if (!mission.ranges.empty()) text += ", " + std::to_string(mission.ranges.size()) + " ranges";
  if (!mission.aoa_measurements.empty())
    text += ", " + std::to_string(mission.aoa_measurements.size()) + " angle measurements";
  std::size_t scans = 0, readings = 0;
  for (const Robot& robot : mission.robots) {
    scans += robot.lidar.size();
    readings += robot.inertial.size();
  }
  if (scans > 0) text += ", " + std::to_string(scans) + " LiDAR scans";
  if (readings > 0) text += ", " + std::to_string(readings) + " IMU samples";
  std::size_t packets = 0;
  for (const Robot& robot : mission.robots)
    if (robot.csi)
      for (const CsiCapture& capture : robot.csi->captures) packets += capture.packets.size();
  if (packets > 0) text += ", " + std::to_string(packets) + " CSI packets";
  if (!mission.matches.empty()) text += ", " + std::to_string(mission.matches.size()) + " matches";
  return text;
}

void simulate_scenario(const SimulateOptions& options) {
  const Scenario& scenario = scenario_named(options.scenario);
  const auto params = with_scenario_settings(scenario.defaults, settings_of(options));
  const RecordedDrive drive = drive_for(options, params);
  OutputFolder output(options.output, kMissionFolder);
  const Simulation simulation = simulate(params, options.seed, drive);
  write_mission(output.path(), simulation.mission, simulation.truth);
  output.commit();
  std::cout << options.output << ": " << summary(simulation.mission) << ", seed " << options.seed << '\n';
  const Mission& mission = simulation.mission;
  const bool has_scans = std::any_of(mission.robots.begin(), mission.robots.end(), [](const Robot& robot) {
    return !robot.wifi.empty() || (robot.csi && !robot.csi->captures.empty());
  });
  if (mission.robots.size() > 1 && !has_scans && mission.ranges.empty() && mission.aoa_measurements.empty())
    std::cout << "note: no two robots ever come within reach of each other's radio: no measurement relates "
                 "their frames\n";
}

std::string scenario_list() {
  std::string text = "Scenarios:\n";
  for (const auto& scenario : scenarios()) {
    text += "  " + std::string(scenario.name) + ": " + std::string(scenario.description) + "\n";
  }
  return text;
}

}  // namespace

void add_simulate(CLI::App& program) {
  const auto options = std::make_shared<SimulateOptions>();
  auto* command = program.add_subcommand("simulate", "Simulate a mission with ground truth");
  command->add_option("SCENARIO", options->scenario, "Scenario to simulate, see below")->required();
  add_output_option(*command, options->output, "Mission folder to write; an existing one is replaced");
  command->add_option("--seed", options->seed, "Random seed of the world and the noise (default: 1)")
      ->check(seed_number())
      ->type_name("N");
  command->add_option("--robots", options->robots, "Number of robots")->type_name("N");
  command->add_option("--trajectory", options->trajectory, "kitti: true poses of the recorded drive")
      ->type_name("FILE");
  command->add_option("--odometry", options->odometry, "kitti: odometry of the recorded drive, in any frame")
      ->type_name("FILE");
  command->add_option("--cut", options->cut, "kitti: fraction of the drive assigned to the first robot")
      ->type_name("FRACTION");
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->footer(scenario_list() +
                  "`radioslam parameters SCENARIO` lists the parameters for --set and --config.\n\n"
                  "Example: three robots whose odometry drifts more\n"
                  "  radioslam simulate carpark -o carpark --robots 3 --set sigma_xy_per_sqrt_m=0.05\n"
                  "Example: a town with few radio links and angles measured at one end only\n"
                  "  radioslam simulate city -o city --set links=8 angle_ends=one");
  command->callback([options] { simulate_scenario(*options); });
}

}  // namespace radioslam::cli
