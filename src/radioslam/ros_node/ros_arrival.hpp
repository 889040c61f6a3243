// A message of ROS 2 as it has arrived.
#pragma once

#include <cstddef>
#include <string>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/ros/ros_recording.hpp"

namespace radioslam {

struct RosArrival {
  static constexpr std::size_t kStaticTransforms = static_cast<std::size_t>(-1);

  std::size_t topic = 0;  ///< of RobotTopics::measured, or kStaticTransforms
  RosChannel channel;
  Stamp received;  ///< by the host's clock
  Stamp clock;     ///< then, by the robot's, which may be simulated
  std::string cdr;

  RosMessage message() const { return {channel, received, cdr, "the wire"}; }
};

}  // namespace radioslam
