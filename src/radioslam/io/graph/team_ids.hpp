// Whose pose an id of a team's g2o files is.
//
// An id has its robot's letter in the top eight bits (GTSAM symbols). Without letters, each of several files
// is a robot with ids of its own; unless the files divide the ids among them, each with its own poses, and
// name poses of others in their links: then an id is that of the file that has it. A file's own ids are those
// of its VERTEX lines, or, where files share these, those of its edges between successive ids. Ids of which
// some have letters and some have none contradict each other: letters are missing, as where ids without
// letters have two odometries of different motions.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Of ids whose robots are letters, the first that has none; nothing where all or none have one. Numbers in
/// place of letters may be 0.
std::optional<std::uint64_t> id_without_letter(std::span<const std::uint64_t> ids);

/// Refuses the id, with the first line that names it.
[[noreturn]] void refuse_missing_letter(const Text& text, std::uint64_t id);

/// Whether edges lead from one id to the next along two trajectories.
enum class SecondOdometry {
  kNone,         ///< few steps are measured twice
  kAgrees,       ///< most are: by two sensors, or by two robots that move alike
  kContradicts,  ///< most are, with other motions: they are those of two robots
};

/// Of ids without letters: what the second edges between successive ids say. `ids`: per pose.
template <class Pose>
SecondOdometry second_odometry(const PoseGraph<Pose>& graph, std::span<const std::uint64_t> ids);

/// Refuses the second trajectory at its first edge.
[[noreturn]] void refuse_second_odometry(const Text& text);

/// Which file has each pose of a team whose files divide the ids among them.
class DividedIds {
 public:
  /// Reads the ids alone, of VERTEX lines and of edges between poses; other lines are not looked at.
  explicit DividedIds(std::span<const Text> texts);

  /// The index of the file that has the pose; nothing if none has, or if each file has ids of its own.
  std::optional<std::size_t> file_of(std::uint64_t id) const;

 private:
  std::map<std::uint64_t, std::size_t> file_of_;
};

}  // namespace radioslam
