// Assembles the factors of a file to a team graph: groups poses into trajectory segments.
//
// Poses are sorted by robot (in the order of first mention) and index. An edge from a pose to the robot's
// next one is odometry; of several such edges the first one is, the others are loop closures. Where odometry
// is missing, a new segment begins. Of edges between two robots that repeat each other (repeated_edges.hpp)
// the first counts, with a note. Cost: sorting the poses, otherwise linear.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/graph/team_graph.hpp"
#include "radioslam/io/graph/team_graph_file.hpp"

namespace radioslam {

/// The robot of a pose and its index along the trajectory; unique per pose.
struct PoseIndex {
  std::string robot;
  std::uint64_t place = 0;
  std::optional<Stamp> stamp;  ///< if absent, the index in seconds is used
};

template <class Pose>
struct AssembledTeam {
  TeamGraphFile<Pose> file;                      ///< its team, with notes on what does not count
  std::vector<std::size_t> file_index;           ///< per pose of the team, its index in the file's graph
  std::vector<std::size_t> relative_pose_index;  ///< the same per relative pose
};

/// `graph` has the file's factors, and poses and points without values; `places` is per pose. Among the
/// relative poses, odometry comes first, in the order of the poses; the others follow in the order of the
/// file. A pose with the stamp of the previous one is moved one nanosecond later. Stamps must not decrease
/// along a robot (first_backward_stamp).
template <class Pose>
AssembledTeam<Pose> assemble_team(PoseGraph<Pose> graph, const std::vector<PoseIndex>& places,
                                  StatedStarts starts);

/// Index in `places` of a pose whose stamp is earlier than that of its robot's previous pose, if there is
/// one.
std::optional<std::size_t> first_backward_stamp(const std::vector<PoseIndex>& places);

// Keys of poses as GTSAM makes them (symbols): a robot's letter in the top eight bits, and below it the index
// along the robot's trajectory.

inline constexpr int kKeyRobotShift = 56;
inline constexpr std::uint64_t kKeyPlaceMask = (std::uint64_t{1} << kKeyRobotShift) - 1;

constexpr bool is_key_letter(std::uint64_t robot) {
  return (robot >= 'a' && robot <= 'z') || (robot >= 'A' && robot <= 'Z');
}

/// The robot of a key: its letter, or "robot7"; keys without one belong to a single robot, "a".
inline std::string robot_of_key(std::uint64_t key) {
  const std::uint64_t robot = key >> kKeyRobotShift;
  if (robot == 0) return "a";
  return is_key_letter(robot) ? std::string(1, static_cast<char>(robot)) : "robot" + std::to_string(robot);
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
