// radioslam rendezvous: one robot of a team that meets when it must, driven from outside.
#include <iostream>
#include <memory>
#include <string>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/io/rendezvous/robot_session.hpp"
#include "radioslam/rendezvous/rendezvous_params.hpp"

namespace radioslam::cli {
namespace {

struct RendezvousOptions {
  bool stdio = false;
  std::string robot;
  std::string policy, monitor;
  ParameterOptions parameters;
};

/// --policy and --monitor win over --set.
RendezvousParams rendezvous_params(const RendezvousOptions& options) {
  auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  if (!options.policy.empty()) settings.push_back({"policy", options.policy, "--policy", 0});
  if (!options.monitor.empty()) settings.push_back({"monitor", options.monitor, "--monitor", 0});
  return with_settings(RendezvousParams{}, settings);
}

void print_lines(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::cout << line << std::endl;
}

/// Answers the lines of standard input until the robot has finished, at the latest at their end.
void drive_robot(const RendezvousOptions& options) {
  if (options.robot.empty()) throw InputError("--robot", 0, "--stdio needs the name of the robot");
  RobotSession session(options.robot, rendezvous_params(options));
  std::string line;
  while (!session.finished() && std::cout && std::getline(std::cin, line)) print_lines(session.line(line));
  print_lines(session.end());
}

void meet(const RendezvousOptions& options) {
  if (!options.stdio) throw InputError("rendezvous", 0, "not yet");
  drive_robot(options);
}

}  // namespace

void add_rendezvous(CLI::App& program) {
  const auto options = std::make_shared<RendezvousOptions>();
  auto* command = program.add_subcommand(
      "rendezvous", "Decide when and how a robot of a team without a map meets the others");
  command->add_flag("--stdio", options->stdio,
                    "Be one robot: read what it measures and hears from standard input, and write what it "
                    "decides to standard output, one JSON object per line");
  command->add_option("--robot", options->robot, "With --stdio: name of the robot")->type_name("ID");
  command
      ->add_option("--policy", options->policy,
                   "How robots meet: active, informed, scheduled or random (default: active)")
      ->type_name("NAME");
  command
      ->add_option("--monitor", options->monitor,
                   "What a robot takes for its error: uncertainty or seed (default: uncertainty)")
      ->type_name("NAME");
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->footer(
      "docs/formats.md describes the lines.\n"
      "`radioslam parameters rendezvous` lists the parameters for --set and --config.\n\n"
      "Example:\n"
      "  radioslam rendezvous --stdio --robot a --policy active < events.jsonl");
  command->callback([options] { meet(*options); });
}

}  // namespace radioslam::cli
