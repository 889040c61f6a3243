#include "radioslam/cli/agent/ros_options.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <thread>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/cli/ending.hpp"
#include "radioslam/cli/team/network_options.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/ros/ros_names.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam::cli {
namespace {

/// "LAT,LON" or "LAT,LON,HEIGHT", in degrees and metres.
GeodeticPlace origin_of(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    if (const auto number = parse_number(text.substr(at, comma - at))) numbers.push_back(*number);
    at = comma + 1;
  }
  const std::size_t commas = static_cast<std::size_t>(std::count(text.begin(), text.end(), ','));
  if (numbers.size() != commas + 1 || commas < 1 || commas > 2 || std::abs(numbers[0]) > 90 ||
      std::abs(numbers[1]) > 360)
    throw InputError("--origin", 0, "'" + text + "' is not LAT,LON or LAT,LON,HEIGHT in degrees and metres");
  return {numbers[0] * kRadiansPerDegree, numbers[1] * kRadiansPerDegree, commas == 2 ? numbers[2] : 0};
}

MissionNames names_of(const std::string& robot, const RosOptions& options) {
  MissionNames names;
  if (!options.mission.empty()) {
    names = read_mission_names(options.mission);
    robot_named(robot, names.mission, "--robot");
    if (options.dimension != 0 && options.dimension != names.mission.dimension)
      throw InputError("--dimension", 0,
                       options.mission + " has dimension " + std::to_string(names.mission.dimension));
    return names;
  }
  if (!is_record_name(robot)) throw InputError("--robot", 0, "'" + robot + "' cannot be a robot's name");
  if (options.dimension == 0)
    throw InputError(
        "--dimension", 0,
        "is wanted with --ros2 unless --mission states it: 2 where the whole team drives on level "
        "ground, else 3");
  names.mission.name = robot;
  names.mission.dimension = options.dimension;
  names.mission.robots.emplace_back().id = robot;
  return names;
}

std::string space_of(const std::string& robot, const RosOptions& options) {
  if (options.space == "/") return {};
  std::string space = options.space.empty() ? as_ros_name(robot) : options.space;
  if (!space.starts_with('/')) space.insert(0, "/");
  if (const std::string problem = problem_with_ros_name(space); !problem.empty())
    throw InputError("--namespace", 0, "'" + options.space + "' " + problem);
  return space;
}

}  // namespace

void add_ros_options(CLI::App& command, RosOptions& options) {
  command.add_flag("--ros2", options.is_on, "The robot's drivers publish its samples on topics of ROS 2");
  command.add_flag("--publish", options.publishes,
                   "With --log too, publish the pose, the path, the map and closures on topics of ROS 2");
  command
      .add_option("--topic", options.topics,
                  "Topic with samples of a kind, where it has another name than by convention, or none; may "
                  "be repeated. Kinds: " +
                      list_of_topic_kinds())
      ->type_name("KIND=NAME")
      ->allow_extra_args(false);
  command
      .add_option("--namespace", options.space,
                  "That of the robot's topics, / for none (default: the robot's name)")
      ->type_name("NAME");
  command
      .add_option("--mission", options.mission,
                  "With --ros2: mission folder whose mission.yaml and anchors.csv describe the team")
      ->type_name("MISSION");
  command
      .add_option("--dimension", options.dimension, "With --ros2, without --mission: 2 in the plane, or 3")
      ->check(CLI::Range(2, 3));
  command
      .add_option("--origin", options.origin,
                  "With --ros2: origin of the frame of position fixes, the same for the whole team")
      ->type_name("LAT,LON[,HEIGHT]");
  command.add_flag("--use-sim-time", options.uses_simulated_time,
                   "The time is that on /clock, as of a simulation or a recording that is played");
}

RobotTopics topics_of(const std::string& robot, const RosOptions& options) {
  return robot_topics(space_of(robot, options), options.topics);
}

RobotSamplesSetup robot_samples_setup(const std::string& robot, const RosOptions& options) {
  MissionNames names = names_of(robot, options);
  RobotSamplesSetup setup;
  setup.self = robot_named(robot, names.mission, "--robot");
  setup.names = std::move(names.mission);
  setup.antennas = std::move(names.antennas);
  setup.topics = topics_of(robot, options);
  if (!options.origin.empty()) setup.origin = origin_of(options.origin);
  setup.is_simulated = options.uses_simulated_time;
  return setup;
}

std::unique_ptr<RosClock> started_clock(DdsDomain& domain, const std::string& topic) {
  constexpr std::chrono::milliseconds kPause{20};
  constexpr std::chrono::seconds kQuiet{5};
  auto clock = std::make_unique<RosClock>(domain, topic);
  bool is_said = false;
  for (const auto begin = std::chrono::steady_clock::now(); !clock->has_begun();) {
    for (const std::string& note : domain.take_notes()) std::cout << note << std::endl;
    if (is_to_conclude()) throw InputError("--use-sim-time", 0, "no time has come on " + topic);
    if (!is_said && std::chrono::steady_clock::now() - begin > kQuiet) {
      std::cout << "waits for a time on " << topic
                << ", where nothing has come for 5 s; is the simulation running, or the recording played "
                   "with `ros2 bag play --clock`?"
                << std::endl;
      is_said = true;
    }
    std::this_thread::sleep_for(kPause);
  }
  return clock;
}

}  // namespace radioslam::cli
