// radioslam rendezvous: a simulated team that meets when it must, or one robot of a team driven from outside.
#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/io/rendezvous/robot_session.hpp"
#include "radioslam/rendezvous/rendezvous_params.hpp"
#include "radioslam/rendezvous_world/rendezvous_run.hpp"
#include "radioslam/rendezvous_world/run_json.hpp"

namespace radioslam::cli {
namespace {

struct RendezvousOptions {
  bool stdio = false;
  std::string robot;
  std::string policy, monitor;
  std::optional<int> robots, iterations;
  std::uint64_t seed = 1;
  bool json = false;
  ParameterOptions parameters;
};

/// Options win over --set. One robot takes those of the simulated floor, too, and has no use for them.
RendezvousRunParams params_of(const RendezvousOptions& options) {
  auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) settings.push_back({key, value, std::string("--") + key, 0});
  };
  add("policy", options.policy);
  add("monitor", options.monitor);
  if (options.robots) add("robots", std::to_string(*options.robots));
  if (options.iterations) add("iterations", std::to_string(*options.iterations));
  return with_settings(RendezvousRunParams{}, settings);
}

void print_lines(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::cout << line << std::endl;
}

/// Answers the lines of standard input until the robot has finished, at the latest at their end.
void drive_robot(const RendezvousOptions& options) {
  if (options.robot.empty()) throw InputError("--robot", 0, "--stdio needs the name of the robot");
  if (options.robots || options.iterations)
    throw InputError("--stdio", 0, "is one robot: --robots and --iterations belong to a simulated team");
  RobotSession session(options.robot, params_of(options).robot);
  std::string line;
  while (!session.finished() && std::cout && std::getline(std::cin, line)) print_lines(session.line(line));
  print_lines(session.end());
  if (!session.has_started())
    throw InputError("standard input", 0,
                     "ended before the robot was started: its first line is {\"start\": {\"t_s\": 0}}; "
                     "docs/formats.md describes the lines");
}

void print_run(const RendezvousRun& run) {
  std::cout << run.iterations << " iterations, " << run.metres_walked << " m walked, " << run.meetings
            << " meetings; error " << std::sqrt(run.ate_trans_mean_squared) << " m (RMSE of all poses), "
            << run.crossings.size() << " crossings of the threshold, " << run.open_crossings
            << " of them open at the end; " << run.seconds << " s\n";
}

void simulate_team(const RendezvousOptions& options) {
  if (!options.robot.empty()) throw InputError("--robot", 0, "belongs to --stdio");
  const auto params = params_of(options);
  RendezvousRunOptions run_options;
  run_options.seed = options.seed;
  ProgressLine line;
  const RendezvousRun run = run_rendezvous(params, run_options, line.progress());
  if (options.json)
    std::cout << rendezvous_run_json(run).dump(2) << '\n';
  else
    print_run(run);
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
                   "How robots meet: active, anchored, scheduled or random (default: active)")
      ->type_name("NAME");
  command
      ->add_option("--monitor", options->monitor,
                   "What a robot takes for its error: uncertainty or seed (default: uncertainty)")
      ->type_name("NAME");
  command->add_option("--robots", options->robots, "Number of simulated robots (default: 2)")
      ->check(CLI::Range(1, 100000));
  command->add_option("--iterations", options->iterations, "Steps that each of them may take (default: 50)")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--seed", options->seed, "Seed of the simulated team")->capture_default_str();
  add_json_option(*command, options->json);
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->footer(
      "Without --stdio a team is simulated: its error over time, its meetings, and its true error.\n"
      "docs/formats.md describes the lines.\n"
      "`radioslam parameters rendezvous` lists the parameters for --set and --config.\n\n"
      "Examples:\n"
      "  radioslam rendezvous --robots 50 --policy active --iterations 50 --seed 1 --json\n"
      "  radioslam rendezvous --stdio --robot a --policy active < events.jsonl");
  command->callback([options] { options->stdio ? drive_robot(*options) : simulate_team(*options); });
}

}  // namespace radioslam::cli
