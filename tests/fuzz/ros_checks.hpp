// Passes a recording's bytes to its reader, and the messages in it to theirs.
#pragma once

#include "lidar_checks.hpp"
#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {

/// Reads a message as the type of its channel.
inline void read_as_said(const RosMessage& message) {
  const std::string& type = message.channel.type;
  if (is_pose_type(type)) read_ros_pose(message);
  if (is_transforms_type(type)) read_ros_transforms(message);
  if (is_scan_type(type)) check_scan(read_ros_scan(message).scan);
  if (is_scan_type(type)) read_ros_point_times(message);
  if (type == kFixType) read_ros_fix(message);
  if (type == kImuType) read_ros_imu(message);
}

/// Calls visit(name, bytes, visitor) with the bytes as a recording.
template <class Visit>
int fuzz_recording(const std::uint8_t* data, std::size_t size, Visit&& visit) {
  const std::string name = "input";
  const std::string bytes(data, data + size);
  try {
    visit(name, bytes, RosVisitor{[](const RosChannel&) { return true; }, read_as_said});
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace radioslam
