#include "radioslam/io/graph/keyed_poses.hpp"

#include <utility>

namespace radioslam {

PoseId KeyedPoses::at(std::uint64_t key, const std::string& robot) {
  const auto [found, is_new] = by_key_.try_emplace(key, PoseId(keys_.size()));
  if (is_new) {
    keys_.push_back(key);
    places_.push_back(place_of_key(key));
    if (!robot.empty()) places_.back().robot = robot;
  }
  return found->second;
}

template <class Pose>
AssembledTeam<Pose> KeyedPoses::assemble(PoseGraph<Pose> graph, StatedStarts starts) const {
  graph.poses.resize(keys_.size());
  AssembledTeam<Pose> assembled = assemble_team(std::move(graph), places_, starts);
  for (const std::size_t k : assembled.file_index) {
    assembled.file.pose_ids.push_back(keys_[k]);
    assembled.file.pose_names.push_back(std::to_string(keys_[k]));
  }
  return assembled;
}

template AssembledTeam<SE2> KeyedPoses::assemble(PoseGraph<SE2>, StatedStarts) const;
template AssembledTeam<SE3> KeyedPoses::assemble(PoseGraph<SE3>, StatedStarts) const;

}  // namespace radioslam
