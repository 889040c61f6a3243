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
#include "radioslam/cli/commands/run_documents.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/journal_store.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/results/result_notes.hpp"
#include "radioslam/team/virtual_team.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

struct TeamArguments {
  std::vector<std::string> mission;
  std::string output, transport = "in-process", partition;
  std::vector<std::string> kills, late;
  double loss = 0, delay_s = 0.05, cap = 1e6;
  std::size_t solvers = kMaxTeam;
  std::uint64_t seed = 1;
  ParameterOptions parameters;
};

double number_of(const std::string& option, const std::string& text) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !std::isfinite(value) || value < 0)
    throw InputError(option, 0, "'" + text + "' is not a time in seconds");
  return value;
}

Stamp after(Stamp begin, double seconds) { return {begin.ns + Stamp::from_seconds(seconds).ns}; }

/// "b@120": robot and time.
std::pair<std::string, double> robot_and_time(const std::string& option, const std::string& text,
                                              char separator, const Mission& mission) {
  const std::size_t at = text.rfind(separator);
  if (at == std::string::npos)
    throw InputError(option, 0, "'" + text + "' is not a robot and a time, as in b" + separator + "120");
  const std::string id = text.substr(0, at);
  for (const Robot& robot : mission.robots)
    if (robot.id == id) return {id, number_of(option, text.substr(at + 1))};
  throw InputError(option, 0, "the mission has no robot '" + id + "'");
}

NetworkFaults faults_of(const TeamArguments& arguments, const Mission& mission) {
  const Stamp begin = begin_of(mission);
  NetworkFaults faults;
  faults.loss = arguments.loss;
  faults.delay_s = arguments.delay_s;
  faults.seed = arguments.seed;
  if (!arguments.partition.empty()) {
    const std::size_t colon = arguments.partition.find(':');
    if (colon == std::string::npos)
      throw InputError("--partition", 0, "'" + arguments.partition + "' is not two times, as in 60:120");
    const double from = number_of("--partition", arguments.partition.substr(0, colon)),
                 to = number_of("--partition", arguments.partition.substr(colon + 1));
    if (!(from < to)) throw InputError("--partition", 0, "it ends before it begins");
    faults.partition = {after(begin, from), after(begin, to)};
  }
  for (const std::string& text : arguments.late) {
    const auto [robot, seconds] = robot_and_time("--late", text, ':', mission);
    faults.late[robot] = after(begin, seconds);
  }
  return faults;
}

/// When the robots are killed.
std::map<std::string, Stamp> kills_of(const TeamArguments& arguments, const Mission& mission) {
  std::map<std::string, Stamp> kills;
  for (const std::string& text : arguments.kills) {
    const auto [robot, seconds] = robot_and_time("--kill", text, '@', mission);
    if (!kills.emplace(robot, after(begin_of(mission), seconds)).second)
      throw InputError("--kill", 0, "robot " + robot + " is killed twice");
  }
  return kills;
}

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

void write_result(const fs::path& folder, const RunOutput& run, const MissionInput& given) {
  fs::create_directories(folder);
  write_run(folder, run.result, documents_of(run, given, evaluate(run.result, given)));
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
  const auto kills = kills_of(arguments, mission);
  VirtualTeamSetup setup{
      .dimension = mission.dimension, .run = params, .network = faults_of(arguments, mission)};
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
    write_result(output.path() / "agents" / agent, found->second, given);
    const Agreement agreement = evaluate(found->second.result, given);
    std::cout << "robot " << agent << ": " << records << " records of " << extents.size() << " robots";
    if (agreement.metrics) std::cout << error_text(*agreement.metrics);
    std::cout << '\n';
    if (records > most_records) {
      most_records = records;
      most = &found->second;
    }
  }
  if (!most) throw InputError(arguments.mission.front(), 0, "no robot has said anything");
  write_result(output.path(), *most, given);
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
  command->add_option("--loss", options->loss, "Probability that a message is lost, each way")
      ->check(CLI::Range(0.0, 0.95));
  command->add_option("--delay", options->delay_s, "Delay of messages, seconds")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command->add_option("--partition", options->partition,
                      "T0:T1, seconds: the first half of the robots and the second do not hear each other");
  command->add_option("--kill", options->kills,
                      "ROBOT@T: the robot's program is killed, and started again 2 s later; may be repeated");
  command->add_option("--late", options->late,
                      "ROBOT:T: the robot's radio is off until then; may be repeated");
  command->add_option("--cap", options->cap, "Largest number of bytes a second from each robot to each other")
      ->check(CLI::Range(1e3, 1e9))
      ->capture_default_str();
  command
      ->add_option("--solvers", options->solvers,
                   "Number of robots that estimate; the others take their solutions (default: all)")
      ->check(CLI::Range(std::size_t{1}, kMaxTeam));
  command->add_option("--seed", options->seed, "Random seed of what is lost")->capture_default_str();
  add_parameter_options(*command, options->parameters);
  command->callback([options] { run_agents(*options); });
}

}  // namespace radioslam::cli
