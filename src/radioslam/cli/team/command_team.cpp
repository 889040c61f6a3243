// radioslam team: a recorded mission, lived through by an agent a robot over a network with faults.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/mission_check.hpp"
#include "radioslam/cli/commands/mission_input.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/cli/run_documents.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/cli/team/journal_store.hpp"
#include "radioslam/cli/team/network_options.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/results/result_notes.hpp"
#include "radioslam/team/virtual_team.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

struct TeamArguments {
  std::vector<std::string> mission;
  std::string output, transport = "in-process";
  NetworkOptions network;
  double cap = 1e6;
  std::size_t solvers = kMaxTeam;
  ParameterOptions parameters;
};

std::string traffic_csv(const TeamRun& run) {
  std::ostringstream table;
  table << "from,to,kind,messages,bytes,lost\n";
  for (const auto& [key, traffic] : run.traffic) {
    const auto& [from, to, kind] = key;
    table << from << ',' << to << ',' << kAgentMessageKinds[kind] << ',' << traffic.messages << ','
          << traffic.bytes << ',' << traffic.lost << '\n';
  }
  return table.str();
}

std::string known_csv(const TeamRun& run, Stamp begin) {
  std::ostringstream table;
  table << "t_s,agent,share,robots_in_frame,ate_m\n" << std::fixed;
  for (const KnownThen& then : run.known) {
    table << std::setprecision(1) << seconds_between(begin, then.at) << ',' << then.agent << ','
          << std::setprecision(4) << then.share << ',' << then.robots_in_frame << ',';
    if (then.error_m) table << *then.error_m;
    table << '\n';
  }
  return table.str();
}

/// The estimate of an agent from the logs that it has in the end.
RunOutput estimate_of(const std::vector<RobotLog>& logs, const RunParams& params) {
  TeamLog team;
  for (const RobotLog& log : logs) team.add(log);
  RunOutput run = run_pipeline(mission_of(team), params);
  run.result.parameters = effective_parameters(params);
  return run;
}

void write_result(const fs::path& folder, const RunOutput& run, const MissionInput& given,
                  const AgentsResult* agents = nullptr) {
  fs::create_directories(folder);
  write_run(folder, run.result, documents_of(run, given, evaluate(run.result, given), nullptr, agents));
}

/// As the page shows it.
AgentsResult agents_result(const TeamRun& run) {
  AgentsResult result;
  for (const KnownThen& then : run.known)
    result.known.push_back({then.at, then.agent, then.share, then.error_m});
  for (const auto& [key, traffic] : run.traffic) {
    AgentsResult::Sent& sent = result.sent[kAgentMessageKinds[std::get<2>(key)]];
    sent.messages += traffic.messages;
    sent.bytes += traffic.bytes;
    sent.lost += traffic.lost;
  }
  for (const auto& [agent, event] : run.events)
    result.events.push_back({event.at, "robot " + agent + ": " + event.what});
  return result;
}

/// Each agent's result, and that of the one that knows most.
void write_results(const TeamRun& run, const RunParams& params, const MissionInput& given,
                   const fs::path& folder) {
  std::map<std::vector<std::pair<std::string, std::uint64_t>>, RunOutput> results;  // by what is known
  const RunOutput* most = nullptr;
  std::size_t most_records = 0;
  for (const auto& [agent, extents] : run.extents) {
    std::vector<std::pair<std::string, std::uint64_t>> known;
    std::size_t records = 0;
    for (const auto& [robot, extent] : extents) {
      known.emplace_back(robot, extent.records);
      records += extent.records;
    }
    auto found = results.find(known);
    if (found == results.end())
      found = results.emplace(std::move(known), estimate_of(run.logs.at(agent), params)).first;
    write_result(folder / "agents" / agent, found->second, given);
    const Agreement agreement = evaluate(found->second.result, given);
    std::cout << "robot " << agent << ": " << records << " records of " << extents.size() << " robots";
    if (agreement.metrics) std::cout << error_text(*agreement.metrics);
    std::cout << '\n';
    if (records > most_records) {
      most_records = records;
      most = &found->second;
    }
  }
  if (!most) throw InputError("team", 0, "no robot has said anything");
  const AgentsResult agents = agents_result(run);
  write_result(folder, *most, given, &agents);
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
  const Mission& mission = input.mission;
  const Stamp begin = begin_of(mission);
  const auto kills = kills_of(arguments.network, mission, begin);
  VirtualTeamSetup setup{
      .dimension = mission.dimension, .run = params, .network = faults_of(arguments.network, mission, begin)};
  setup.agent.bytes_s = arguments.cap;
  setup.solvers = arguments.solvers;
  const fs::path journals = output.path() / "journals";
  setup.store = [&](const std::string& robot) -> std::unique_ptr<AgentStore> {
    if (!kills.contains(robot)) return store_in_memory(robot, 1);
    fs::create_directories(journals);
    return std::make_unique<JournalStore>(journals / (robot + ".journal"), robot, 1);
  };
  setup.error_of = [&](const std::vector<EstimatedTrajectory>& team) -> std::optional<double> {
    if (given.truth.empty()) return std::nullopt;
    const auto ate = evaluate_trajectories(team, given.truth, mission.dimension).ate;
    return ate ? std::optional(ate->rmse_m) : std::nullopt;
  };
  ProgressLine line;
  const auto script = scripted_robots(mission, params, kills);
  const TeamRun run = run_team(script, setup, line.progress());
  fs::remove_all(journals);

  write_results(run, params, given, output.path());
  write_file(output.path() / "traffic.csv", traffic_csv(run));
  write_file(output.path() / "known.csv", known_csv(run, begin));
  output.commit();
  std::size_t bytes = 0;
  for (const auto& [key, traffic] : run.traffic) bytes += traffic.bytes;
  std::cout << arguments.output << ": " << script.size() << " agents, " << run.estimates << " estimates ("
            << run.computed << " of them computed, the others shared), " << bytes << " bytes sent in "
            << seconds_between(begin, run.end) << " s\n";
}

}  // namespace

void add_team(CLI::App& program) {
  const auto options = std::make_shared<TeamArguments>();
  auto* command =
      program.add_subcommand("team", "Live through a mission with an agent a robot, over a faulty network");
  add_mission_option(*command, options->mission);
  add_output_option(*command, options->output, "Folder to write; the folder of an earlier run is replaced");
  command->add_option("--transport", options->transport, "How the agents are connected")
      ->check(CLI::IsMember({"in-process"}))
      ->capture_default_str();
  command->add_option("--loss", options->network.loss, "Probability that a message is lost, each way")
      ->check(CLI::Range(0.0, 0.95));
  command->add_option("--delay", options->network.delay_s, "Delay of messages, seconds")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command->add_option("--partition", options->network.partition,
                      "T0:T1, seconds: the first half of the robots and the second do not hear each other");
  command->add_option("--kill", options->network.kills,
                      "ROBOT@T: the robot's program is killed, and started again 2 s later; may be repeated");
  command->add_option("--late", options->network.late,
                      "ROBOT:T: the robot's radio is off until then; may be repeated");
  command->add_option("--cap", options->cap, "Largest number of bytes a second from each robot to each other")
      ->check(CLI::Range(1e3, 1e9))
      ->capture_default_str();
  command
      ->add_option("--solvers", options->solvers,
                   "Number of robots that estimate; the others take their solutions (default: all)")
      ->check(CLI::Range(std::size_t{1}, kMaxTeam));
  command->add_option("--seed", options->network.seed, "Random seed of what is lost")->capture_default_str();
  add_parameter_options(*command, options->parameters);
  command->callback([options] { run_agents(*options); });
}

}  // namespace radioslam::cli
