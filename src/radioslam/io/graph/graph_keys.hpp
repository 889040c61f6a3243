// Keys of poses as GTSAM makes them (symbols): a robot's letter in the top eight bits, and below it the index
// along the robot's trajectory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "radioslam/io/graph/team_assembly.hpp"

namespace radioslam {

inline constexpr int kKeyRobotShift = 56;
inline constexpr std::uint64_t kKeyPlaceMask = (std::uint64_t{1} << kKeyRobotShift) - 1;

/// The robot of a key: its letter, or "robot7"; keys without one belong to a single robot, "a".
inline std::string robot_of_key(std::uint64_t key) {
  const std::uint64_t robot = key >> kKeyRobotShift;
  if (robot == 0) return "a";
  const bool is_letter = (robot >= 'a' && robot <= 'z') || (robot >= 'A' && robot <= 'Z');
  return is_letter ? std::string(1, static_cast<char>(robot)) : "robot" + std::to_string(robot);
}

inline PoseIndex place_of_key(std::uint64_t key) {
  return {robot_of_key(key), key & kKeyPlaceMask, std::nullopt};
}

/// The key of a robot with one letter; nothing for other names, and places beyond a key's bits.
inline std::optional<std::uint64_t> key_of(const PoseIndex& place) {
  if (place.robot.size() != 1 || place.place > kKeyPlaceMask) return std::nullopt;
  return (std::uint64_t{static_cast<unsigned char>(place.robot.front())} << kKeyRobotShift) | place.place;
}

}  // namespace radioslam
