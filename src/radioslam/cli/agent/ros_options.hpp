// What a command line states of a robot that measures by ROS 2.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/ros_node/robot_samples.hpp"
#include "radioslam/ros_node/ros_clock.hpp"

namespace radioslam::cli {

struct RosOptions {
  bool is_on = false, publishes = false, uses_simulated_time = false;
  std::vector<std::string> topics;
  std::string space;    ///< namespace; empty: the robot's name
  std::string mission;  ///< folder
  std::string origin;
  int dimension = 0;  ///< 0: that of the mission
};

void add_ros_options(CLI::App& command, RosOptions& options);

/// Each throws InputError for what cannot be, naming the option.
RobotTopics topics_of(const std::string& robot, const RosOptions& options);
RobotSamplesSetup robot_samples_setup(const std::string& robot, const RosOptions& options);

/// The clock once it shows a time. After some seconds without one it says what may be wrong, on standard
/// output; throws InputError when the user ends the program before.
std::unique_ptr<RosClock> started_clock(DdsDomain& domain, const std::string& topic);

}  // namespace radioslam::cli
