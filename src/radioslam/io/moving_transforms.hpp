// Poses of one frame in another out of the transforms of a topic, over as many moving ones as lie between.
//
// T_frame_child is the product along the way with the fewest moving transforms (in either direction), with
// fixed ones before, between and behind them. It is told at the times of that moving transform which has the
// most messages; the others are interpolated, and where one of them is not known yet or no more, there is no
// pose.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/frame_tree.hpp"
#include "radioslam/io/ros_types.hpp"

namespace radioslam {

struct TransformedPoses {
  std::vector<StampedPose<SE3>> poses;  ///< not in the order of time where they were not told so
  std::size_t without_pose = 0;         ///< messages that are none: not finite, or without orientation
  std::size_t without_time = 0;         ///< that have the time of their recording
  std::size_t alone = 0;                ///< when another transform is not known
};

class MovingTransforms {
 public:
  /// Takes a message of transforms.
  void take(const RosMessage& message);

  /// No poses where no way leads from `frame` to `child`. O(n log n) in the messages.
  TransformedPoses find(const FrameTree& fixed, const std::string& frame, const std::string& child) const;

 private:
  struct Link {
    std::vector<StampedPose<SE3>> poses;  ///< T_parent_child
    std::size_t without_pose = 0, without_time = 0;
  };
  using Links = std::map<std::pair<std::string, std::string>, Link>;  ///< by parent and child

  /// T_before T_parent_child, or the inverse of the latter.
  struct Step {
    Links::const_iterator link;
    SE3 T_before;
    bool is_backward = false;

    const std::string& target() const { return is_backward ? link->first.first : link->first.second; }
    SE3 apply(const SE3& T_parent_child) const {
      return T_before * (is_backward ? T_parent_child.inverse() : T_parent_child);
    }
  };
  struct Way {
    std::vector<Step> steps;
    SE3 T_behind;
  };

  std::optional<Step> step_over(const FrameTree& fixed, const std::string& from,
                                Links::const_iterator link) const;
  std::optional<Way> find_way(const FrameTree& fixed, const std::string& frame,
                              const std::string& child) const;

  Links links_;
};

}  // namespace radioslam
