// Which of a recording's transforms never change: those of topics called tf_static, and of any other topic of
// transforms the pairs of frames that keep one value over the recording. ROS 1 has many publishers that
// repeat a fixed transform on /tf.
//
// A pair keeps its value where it is told at least twice and every T_parent_child is within 1e-6 (m, rad) of
// the first. A value of tf_static counts more than one that was repeated elsewhere.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/io/frame_tree.hpp"
#include "radioslam/io/ros_types.hpp"

namespace radioslam {

class FixedTransforms {
 public:
  /// Takes a message of transforms; RosMessage as visit_recording hands it on.
  void take(const RosMessage& message);

  FrameTree tree() const;

 private:
  struct Repeated {
    SE3 T_parent_child;  ///< the first one
    std::size_t times = 0;
    bool moves = false;
  };

  std::vector<RosPose> told_fixed_;
  std::map<std::pair<std::string, std::string>, Repeated> repeated_;  ///< by parent and child
};

}  // namespace radioslam
