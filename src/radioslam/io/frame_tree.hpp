// How a robot's frames lie to each other where they do not move: the fixed transforms of ROS.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "radioslam/geometry/se3.hpp"

namespace radioslam {

class FrameTree {
 public:
  /// Of two that name the same child the later one counts.
  void add(const std::string& parent, const std::string& child, const SE3& T_parent_child);

  bool knows(const std::string& frame) const;
  /// T_a_b over any chain of transforms; nothing where none leads from a to b. O(frames squared).
  std::optional<SE3> find(const std::string& a, const std::string& b) const;

 private:
  struct Link {
    std::string parent;
    SE3 T_parent_child;
  };

  /// T_ancestor_frame of the frame's ancestors and of itself, by their names; a loop ends it.
  std::map<std::string, SE3> ancestors_of(const std::string& frame) const;

  std::map<std::string, Link> parents_;  ///< by child
};

}  // namespace radioslam
