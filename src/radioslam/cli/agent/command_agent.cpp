// radioslam agent: one robot of a team as a program of its own.
#include "radioslam/cli/agent/command_agent.hpp"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/cli/agent/agent_process.hpp"
#include "radioslam/cli/agent/mcap_sink.hpp"
#include "radioslam/cli/agent/recorded_source.hpp"
#include "radioslam/cli/agent/ros_options.hpp"
#include "radioslam/cli/agent/ros_source.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/mission_input.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/ending.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/cli/team/journal_store.hpp"
#include "radioslam/cli/team/live_options.hpp"
#include "radioslam/cli/team/network_options.hpp"
#include "radioslam/cli/team/team_output.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

struct AgentArguments {
  std::string robot, log, journal, output, start, mcap, live, live_token;
  std::vector<std::string> peers;
  DdsConfig dds;
  double rate = 1, cap = 1e6;
  RosOptions ros;
  ParameterOptions parameters;
};

constexpr const char* kStart = "start";  // in the journal

/// Which log of the robot it is that begins now: the later, the higher.
std::uint32_t new_life() {
  constexpr std::int64_t kSince_s = 1'735'689'600;  // 2025-01-01
  constexpr std::int64_t kPart_ns = 100'000'000;
  return static_cast<std::uint32_t>((time_of_host().ns - kSince_s * 1'000'000'000) / kPart_ns);
}

Stamp stamp_of_option(const std::string& text) {
  const auto seconds = parse_number(text);
  if (!seconds || !(*seconds > 0 && *seconds < 9e9))
    throw InputError("--start", 0, "'" + text + "' is no time in seconds since 1970");
  return Stamp::from_seconds(*seconds);
}

/// When the mission began: as told, as the journal has it, or now.
Stamp start_of(const AgentArguments& arguments, AgentStore& store) {
  const auto kept = store.state(kStart);
  const Stamp start = !arguments.start.empty() ? stamp_of_option(arguments.start)
                      : kept                   ? Stamp{std::stoll(*kept)}
                                               : time_of_host();
  JournalChange change;
  change.state[kStart] = std::to_string(start.ns);
  store.commit(change);
  return start;
}

/// The drivers of a robot are participants of its host, many, and found by multicast, as nodes of ROS 2 are.
DdsConfig dds_config(const AgentArguments& arguments) {
  constexpr std::uint32_t kNodesPerHost = 100;
  DdsConfig config = arguments.dds;
  const bool has_drivers = arguments.ros.is_on && !config.interface.starts_with("127.");
  config.discovery = arguments.peers.empty() || has_drivers ? DdsDiscovery::kMulticast : DdsDiscovery::kPeers;
  config.peers = arguments.peers;
  if (has_drivers) config.robots_per_host = std::max(config.robots_per_host, kNodesPerHost);
  return config;
}

/// Where the page is, and the token that it asks for: none on this machine alone.
LivePageSetup page_setup(const AgentArguments& arguments) {
  const LiveAddress address = parse_live_address(arguments.live);
  refuse_unusable(address);
  return {.address = address,
          .token = token_of(address, arguments.live_token),
          .robot = arguments.robot,
          .start = {},
          .rate = arguments.rate};
}

/// What it is the same for, wherever its samples come from.
struct Life {
  const AgentArguments& arguments;
  const RunParams& params;
  OutputFolder& output;
  DdsDomain& domain;
  AgentStore& store;
  std::optional<LivePageSetup> page;
};

void live(const Life& life, AgentProcessSetup setup, const MissionInput& given, const MissionClock& clock,
          SampleSource& source, const RobotTopics& topics) {
  RosPublisher publisher;
  AgentPublisher published(setup.robot, topics.space, topics.transforms, life.params, publisher);
  std::optional<DdsSink> sink;
  if (life.arguments.ros.publishes || life.arguments.ros.is_on) {
    publisher.add(sink.emplace(life.domain, published.topics()));
    setup.publisher = &published;
  }
  std::optional<McapSink> mcap;
  if (!life.arguments.mcap.empty()) {
    publisher.add(mcap.emplace(life.arguments.mcap));
    setup.publisher = &published;
  }
  setup.agent.bytes_s = life.arguments.cap;
  setup.say = [&](const std::string& robot, const TeamEvent& event) {
    std::cout << std::fixed << std::setprecision(1) << seconds_between(clock.begin(), event.at)
              << " s: robot " << robot << ' ' << event.what << std::endl;
  };
  setup.is_to_conclude = is_to_conclude;
  std::optional<LivePage> page;
  if (life.page) {
    LivePageSetup page_of = *life.page;
    page_of.dimension = setup.dimension;
    page_of.start = clock.begin();
    setup.page = &page.emplace(page_of, life.params);
    std::cout << "robot " << setup.robot << " is shown at " << page->url() << std::endl;
  }
  const TeamRun run = AgentProcess(setup, life.store, clock, life.domain, source).live();
  if (page) page->end();
  write_agent(run, life.arguments.robot, life.params, given, life.output.path(), clock.begin());
  write_tables(life.output.path(), run, clock.begin());
  life.output.commit();
  if (mcap) mcap->commit();
}

void live_through_recording(const Life& life) {
  const AgentArguments& arguments = life.arguments;
  MissionInput input = read_input({arguments.log});
  if (!input.is_recorded())
    throw InputError(arguments.log, 0, "an agent lives through a recorded mission, which this is not");
  const MissionInput given = for_evaluation(input);
  const Mission& mission = input.mission;
  const RobotIndex self = robot_named(arguments.robot, mission, "--robot");
  const MissionClock clock(begin_of(mission), start_of(arguments, life.store), arguments.rate);
  AgentProcessSetup setup{
      .robot = arguments.robot, .dimension = mission.dimension, .run = life.params, .end = end_of(mission)};
  for (const Robot& robot : mission.robots) setup.team.push_back(robot.id);
  setup.error_of = [&](const std::vector<EstimatedTrajectory>& team) {
    return team_error_m(team, given.truth, mission.dimension);
  };
  RecordedSource source(mission, self, log_before(life.store, arguments.robot).has_value(), clock);
  live(life, std::move(setup), given, clock, source, topics_of(arguments.robot, arguments.ros));
}

void live_on_ros(const Life& life) {
  const AgentArguments& arguments = life.arguments;
  RobotSamplesSetup samples = robot_samples_setup(arguments.robot, arguments.ros);
  const RobotTopics topics = samples.topics;
  MissionInput given;
  given.mission = samples.names;
  AgentProcessSetup setup{.robot = arguments.robot, .dimension = samples.names.dimension, .run = life.params};
  setup.error_of = [](const std::vector<EstimatedTrajectory>&) { return std::nullopt; };
  std::unique_ptr<RosClock> simulated;
  if (arguments.ros.uses_simulated_time) simulated = started_clock(life.domain, topics.clock);
  const std::function<Stamp()> time =
      simulated ? [&simulated] { return simulated->now(); } : std::function<Stamp()>(host_time);
  const MissionClock clock(time);
  RosSource source(std::move(samples));
  RosSubscriptions subscriptions(life.domain, topics, time,
                                 [&source](RosArrival arrival) { source.add(std::move(arrival)); });
  setup.subscriptions = &subscriptions;
  live(life, std::move(setup), given, clock, source, topics);
}

void run_agent(const AgentArguments& arguments) {
  if (arguments.ros.is_on != arguments.log.empty())
    throw InputError("agent", 0, "a robot's samples come from --log MISSION or from --ros2, one of the two");
  std::optional<LivePageSetup> page;
  if (!arguments.live.empty()) page = page_setup(arguments);
  const auto params = with_settings(
      RunParams{}, collect_settings(arguments.parameters.config_path, arguments.parameters.set));
  std::vector<std::string> inputs{arguments.log, arguments.journal};
  if (!arguments.mcap.empty()) refuse_replacing_inputs(arguments.mcap, inputs);
  if (!arguments.ros.mission.empty()) inputs.push_back(arguments.ros.mission);
  refuse_replacing_inputs(arguments.output, inputs);
  OutputFolder output(arguments.output, kRunFolder);
  std::unique_ptr<AgentStore> store;
  if (arguments.journal.empty())
    store = store_of_nothing(new_life());
  else
    store = std::make_unique<JournalStore>(arguments.journal, arguments.robot, new_life());
  DdsDomain domain(dds_config(arguments));
  conclude_on_signal();
  const Life life{arguments, params, output, domain, *store, std::move(page)};
  if (arguments.ros.is_on)
    live_on_ros(life);
  else
    live_through_recording(life);
}

}  // namespace

void add_agent_options(CLI::App& program) {
  const auto options = std::make_shared<AgentArguments>();
  auto* command =
      program.add_subcommand("agent", "Run one robot of a team, which talks to the others by DDS");
  command->add_option("--robot", options->robot, "Which robot it is")->required()->type_name("ID");
  command->add_option("--log", options->log, "Mission whose recordings of the robot are replayed")
      ->type_name("MISSION");
  add_ros_options(*command, options->ros);
  command
      ->add_option("--mcap", options->mcap, "Write all that it publishes to this file as well, for Foxglove")
      ->type_name("FILE");
  command->add_option("--rate", options->rate, "How many times faster than it was recorded")
      ->check(number_from(0.01, 1000))
      ->capture_default_str();
  command
      ->add_option("--start", options->start,
                   "When the mission begins, seconds since 1970, the same for the whole team (default: now)")
      ->type_name("S");
  command
      ->add_option("--journal", options->journal,
                   "What outlives the program: started again with it, the robot goes on")
      ->type_name("FILE");
  command->add_option("--domain", options->dds.domain, "DDS domain of the team, as ROS_DOMAIN_ID")
      ->check(CLI::Range(std::uint32_t{0}, kLastDdsDomain))
      ->capture_default_str();
  command
      ->add_option("--peer", options->peers,
                   "Host at which other robots are looked for, without multicast; may be repeated (default: "
                   "by multicast)")
      ->type_name("ADDRESS")
      ->allow_extra_args(false);
  command->add_option("--interface", options->dds.interface, "Network interface, by name or address")
      ->type_name("NAME");
  command
      ->add_option("--robots-per-host", options->dds.robots_per_host,
                   "How many robots are looked for at each host")
      ->check(CLI::Range(1, 120))
      ->capture_default_str();
  command->add_option("--cap", options->cap, "Largest number of bytes a second to each other robot")
      ->check(CLI::Range(1e3, 1e9))
      ->capture_default_str();
  add_live_options(*command, options->live, options->live_token);
  add_output_option(*command, options->output, "Folder to write; the folder of an earlier run is replaced");
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->callback([options] { run_agent(*options); });
}

}  // namespace radioslam::cli
