// The poses of a graph file that names them by keys (team_assembly.hpp), numbered in the order of first
// mention.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "radioslam/io/graph/team_assembly.hpp"

namespace radioslam {

class KeyedPoses {
 public:
  /// The pose of a key. If it is new, it belongs to the robot of its key, or to `robot` unless this is empty.
  PoseId at(std::uint64_t key, const std::string& robot = {});

  const std::vector<std::uint64_t>& keys() const { return keys_; }  ///< per pose
  const std::vector<PoseIndex>& places() const { return places_; }  ///< per pose
  const std::map<std::uint64_t, PoseId>& by_key() const { return by_key_; }

  /// Assembles the team of a graph that has the factors between these poses; keys are the poses' names.
  template <class Pose>
  AssembledTeam<Pose> assemble(PoseGraph<Pose> graph, StatedStarts starts) const;

 private:
  std::vector<std::uint64_t> keys_;
  std::vector<PoseIndex> places_;
  std::map<std::uint64_t, PoseId> by_key_;
};

}  // namespace radioslam
