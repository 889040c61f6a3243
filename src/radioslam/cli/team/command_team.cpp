// radioslam team: a recorded mission, lived through by an agent a robot: over a network with faults in
// virtual time, or as processes that talk by DDS.
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/mission_input.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/cli/team/journal_store.hpp"
#include "radioslam/cli/team/live_options.hpp"
#include "radioslam/cli/team/network_options.hpp"
#include "radioslam/cli/team/process_team.hpp"
#include "radioslam/cli/team/team_output.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInProcess = "in-process";
constexpr const char* kDds = "dds";

struct TeamArguments {
  std::vector<std::string> mission;
  std::string output, transport, live, live_token;
  NetworkOptions network;
  double cap = 1e6;
  std::size_t solvers = kMaxTeam;
  double rate = 1;
  std::optional<std::uint32_t> domain;
  ParameterOptions parameters;
};

/// Options that one kind of transport alone has.
constexpr std::array kOfInProcess{"--loss", "--delay",   "--partition", "--kill",
                                  "--late", "--solvers", "--seed"};
constexpr std::array kOfDds{"--rate", "--domain", "--live", "--live-token"};

TeamRun run_in_process(const TeamArguments& arguments, const Mission& mission, const RunParams& params,
                       const Truth& truth, const fs::path& folder) {
  const Stamp begin = begin_of(mission);
  const auto kills = kills_of(arguments.network, mission, begin);
  VirtualTeamSetup setup{
      .dimension = mission.dimension, .run = params, .network = faults_of(arguments.network, mission, begin)};
  setup.agent.bytes_s = arguments.cap;
  setup.solvers = arguments.solvers;
  const fs::path journals = folder / "journals";
  setup.store = [&](const std::string& robot) -> std::unique_ptr<AgentStore> {
    if (!kills.contains(robot)) return store_of_nothing(1);
    fs::create_directories(journals);
    return std::make_unique<JournalStore>(journals / (robot + ".journal"), robot, 1);
  };
  setup.error_of = [&](const std::vector<EstimatedTrajectory>& team) {
    return team_error_m(team, truth, mission.dimension);
  };
  ProgressLine line;
  TeamRun run = run_team(scripted_robots(mission, params, kills), setup, line.progress());
  fs::remove_all(journals);
  return run;
}

/// Where every robot's page is; said before anything starts.
void set_pages(const TeamArguments& arguments, ProcessTeamSetup& setup) {
  LiveAddress page = parse_live_address(arguments.live);
  if (page.port == 0)
    throw InputError("--live", 0, "a team needs a port, with those behind it for the others");
  setup.live = page;
  setup.live_token = token_of(page, arguments.live_token);
  for (const std::string& robot : setup.robots) {
    refuse_unusable(page);
    std::cout << "robot " << robot << " is shown at " << url_of(page, setup.live_token) << std::endl;
    ++page.port;
  }
}

ProcessTeamRun run_by_dds(const TeamArguments& arguments, const Mission& mission, const fs::path& folder) {
  ProcessTeamSetup setup{.mission = arguments.mission.front(),
                         .robots = names_of(mission.robots),
                         .dimension = mission.dimension,
                         .begin = begin_of(mission),
                         .rate = arguments.rate,
                         .domain = arguments.domain,
                         .options = {"--cap", format_number(arguments.cap)}};
  if (!arguments.parameters.config_path.empty())
    setup.options.insert(setup.options.end(), {"--config", arguments.parameters.config_path});
  for (const std::string& assignment : arguments.parameters.set)
    setup.options.insert(setup.options.end(), {"--set", assignment});
  const std::size_t threads = std::max<std::size_t>(1, thread_count() / setup.robots.size());
  setup.options.insert(setup.options.end(), {"--threads", std::to_string(threads)});
  if (!arguments.live.empty()) set_pages(arguments, setup);
  return run_processes(setup, folder);
}

void run_agents(const TeamArguments& arguments) {
  const auto settings = collect_settings(arguments.parameters.config_path, arguments.parameters.set);
  const auto params = with_settings(RunParams{}, settings);
  refuse_replacing_inputs(arguments.output, arguments.mission);
  OutputFolder output(arguments.output, kRunFolder);
  MissionInput input = read_input(arguments.mission);
  if (!input.is_recorded())
    throw InputError(arguments.mission.front(), 0,
                     "agents live through a recorded mission, which this is not");
  const MissionInput given = for_evaluation(input);
  const bool is_dds = arguments.transport == kDds;
  ProcessTeamRun team;
  if (is_dds)
    team = run_by_dds(arguments, input.mission, output.path());
  else
    team.run = run_in_process(arguments, input.mission, params, given.truth, output.path());
  const TeamRun& run = team.run;
  const Stamp begin = begin_of(input.mission);
  if (run.extents.empty() && !team.failed.empty()) throw InputError("team", 0, team.failed.front());
  write_results(run, params, given, output.path(), is_dds ? AgentFolders::kThere : AgentFolders::kWritten,
                begin);
  write_tables(output.path(), run, begin);
  output.commit();
  std::size_t bytes = 0;
  for (const auto& [key, traffic] : run.traffic) bytes += traffic.bytes;
  std::cout << arguments.output << ": " << run.extents.size() << " agents, ";
  if (!is_dds)
    std::cout << run.estimates << " estimates (" << run.computed << " of them computed, the others shared), ";
  std::cout << bytes << " bytes sent in " << seconds_between(begin, run.end) << " s\n";
  if (team.failed.empty()) return;
  std::string all;
  for (const std::string& line : team.failed) all += (all.empty() ? "" : "; ") + line;
  throw InputError(arguments.output, 0, all + "; what the others know is there");
}

/// Chooses the transport where none is given. Refuses what the other kind of transport has.
void check_options(const CLI::App& command, TeamArguments& arguments) {
  const bool has_faults = std::any_of(kOfInProcess.begin(), kOfInProcess.end(),
                                      [&](const char* option) { return command.count(option) > 0; });
  if (arguments.transport.empty()) arguments.transport = has_faults ? kInProcess : kDds;
  const auto refuse = [&](const auto& options, const std::string& transport) {
    for (const char* option : options)
      if (command.count(option) > 0)
        throw InputError("team", 0, std::string(option) + " is for --transport " + transport + " alone");
  };
  if (arguments.transport == kDds)
    refuse(kOfInProcess, kInProcess);
  else
    refuse(kOfDds, kDds);
}

}  // namespace

void add_team(CLI::App& program) {
  const auto options = std::make_shared<TeamArguments>();
  auto* command =
      program.add_subcommand("team", "Live through a mission with an agent a robot, over a faulty network");
  add_mission_option(*command, options->mission);
  add_output_option(*command, options->output, "Folder to write; the folder of an earlier run is replaced");
  command
      ->add_option(
          "--transport", options->transport,
          "How the agents are connected: in virtual time, or as processes that talk by DDS (default: dds, "
          "without options of the other kind)")
      ->check(CLI::IsMember({kInProcess, kDds}));
  command->add_option("--loss", options->network.loss, "Probability that a message is lost, each way")
      ->check(CLI::Range(0.0, 0.95));
  command->add_option("--delay", options->network.delay_s, "Delay of messages, seconds")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command->add_option(
      "--partition", options->network.partition,
      "T0:T1[:ROBOT,...], seconds: these robots (default: the first half) and the others do not "
      "hear each other");
  command->add_option("--kill", options->network.kills,
                      "ROBOT@T[:T_BACK]: the robot's program is killed, and started again at T_BACK; may be "
                      "repeated, for other robots");
  command->add_option("--late", options->network.late,
                      "ROBOT:T: the robot's radio is off until then; may be repeated");
  command->add_option("--cap", options->cap, "Largest number of bytes a second from each robot to each other")
      ->check(CLI::Range(1e3, 1e9))
      ->capture_default_str();
  command
      ->add_option("--solvers", options->solvers,
                   "Number of robots that estimate; the others take their solutions (default: all)")
      ->check(CLI::Range(std::size_t{1}, kMaxTeam));
  command->add_option("--rate", options->rate, "How many times faster than it was recorded (dds)")
      ->check(number_from(0.01, 1000))
      ->capture_default_str();
  command->add_option("--domain", options->domain, "DDS domain of the team (default: a free one)")
      ->check(CLI::Range(std::uint32_t{0}, std::uint32_t{232}));
  add_live_options(*command, options->live, options->live_token);
  command->add_option("--seed", options->network.seed, "Random seed of what is lost")->capture_default_str();
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->callback([options, command] {
    check_options(*command, *options);
    run_agents(*options);
  });
}

}  // namespace radioslam::cli
