// Tree of the static transforms between a robot's frames (tf_static in ROS).
#pragma once

#include <map>
#include <optional>
#include <string>

#include "radioslam/geometry/se3.hpp"

namespace radioslam {

class FrameTree {
 public:
  /// Adds a transform; it replaces an earlier one with the same child.
  void add(const std::string& parent, const std::string& child, const SE3& T_parent_child);

  bool knows(const std::string& frame) const;
  /// T_a_b along the chain of transforms from a to b; nothing if they are not connected. O(frames squared).
  std::optional<SE3> find(const std::string& a, const std::string& b) const;

 private:
  struct Link {
    std::string parent;
    SE3 T_parent_child;
  };

  /// T_ancestor_frame for the frame and all its ancestors, by name; stops at a loop.
  std::map<std::string, SE3> ancestors_of(const std::string& frame) const;

  std::map<std::string, Link> parents_;  ///< by child
};

}  // namespace radioslam
