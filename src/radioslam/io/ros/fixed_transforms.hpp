// Finds the static transforms of a ROS recording: those on topics called tf_static, and pairs of frames on
// any other transform topic whose value stays constant (many ROS 1 publishers repeat static transforms on
// /tf).
//
// A pair is constant if it has at least two messages and every T_parent_child is within 1e-6 (m, rad) of the
// first one. Values on tf_static take precedence over constant ones on other topics.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/io/ros/frame_tree.hpp"
#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {

class FixedTransforms {
 public:
  /// Adds a message of transforms, as passed on by visit_recording.
  void take(const RosMessage& message);

  FrameTree tree() const;

 private:
  struct Repeated {
    SE3 T_parent_child;  ///< the first value
    std::size_t times = 0;
    bool moves = false;
  };

  std::vector<RosPose> static_;
  std::map<std::pair<std::string, std::string>, Repeated> repeated_;  ///< by parent and child
};

}  // namespace radioslam
