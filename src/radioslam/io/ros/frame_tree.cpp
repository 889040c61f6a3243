#include "radioslam/io/ros/frame_tree.hpp"

#include <algorithm>

namespace radioslam {

void FrameTree::add(const std::string& parent, const std::string& child, const SE3& T_parent_child) {
  parents_[child] = {parent, T_parent_child};
}

bool FrameTree::knows(const std::string& frame) const {
  return parents_.contains(frame) || std::any_of(parents_.begin(), parents_.end(), [&](const auto& link) {
           return link.second.parent == frame;
         });
}

std::map<std::string, SE3> FrameTree::ancestors_of(const std::string& frame) const {
  std::map<std::string, SE3> ancestors{{frame, SE3()}};
  SE3 T_ancestor_frame;
  for (auto link = parents_.find(frame); link != parents_.end(); link = parents_.find(link->second.parent)) {
    T_ancestor_frame = link->second.T_parent_child * T_ancestor_frame;
    if (!ancestors.emplace(link->second.parent, T_ancestor_frame).second) break;
  }
  return ancestors;
}

std::optional<SE3> FrameTree::find(const std::string& a, const std::string& b) const {
  const auto of_a = ancestors_of(a);
  const auto of_b = ancestors_of(b);
  for (const auto& [frame, T_frame_b] : of_b)
    if (const auto common = of_a.find(frame); common != of_a.end())
      return common->second.inverse() * T_frame_b;
  return std::nullopt;
}

}  // namespace radioslam
