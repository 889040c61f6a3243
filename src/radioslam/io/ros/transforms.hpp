// Transforms between the frames of a ROS recording: static ones, and poses along chains of moving ones.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {

// Tree of the static transforms between a robot's frames (tf_static in ROS).
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

struct TransformedPoses {
  std::vector<StampedPose<SE3>> poses;  ///< in the order of the messages, which may differ from that of time
  std::size_t without_pose = 0;         ///< messages without a valid pose: not finite, or without orientation
  std::size_t without_time = 0;         ///< messages without a stamp, which got the time of their recording
  std::size_t left_without_time = 0;    ///< the same, left out because others have stamps
  std::size_t alone = 0;                ///< stamps at which another transform is unknown
};

/// Computes the poses of one frame in another from a topic of transforms, along a chain of any number of
/// moving ones.
///
/// T_frame_child is the product along the chain with the fewest moving transforms (in either direction), with
/// static ones before, between and after them. Its stamps are those of the moving transform with the most
/// messages; the others are interpolated. There is no pose at stamps outside the interval of one of them.
class MovingTransforms {
 public:
  /// Adds a message of transforms.
  void take(const RosMessage& message);

  /// The poses T_frame_child; none if no chain connects the frames. O(n log n) in the number of messages.
  TransformedPoses find(const FrameTree& fixed, const std::string& frame, const std::string& child) const;

 private:
  struct Link {
    std::vector<StampedPose<SE3>> poses;     ///< T_parent_child
    std::vector<StampedPose<SE3>> timeless;  ///< at the time of their recording; used if `poses` is empty
    std::size_t without_pose = 0;

    const std::vector<StampedPose<SE3>>& used() const { return poses.empty() ? timeless : poses; }
  };
  using Links = std::map<std::pair<std::string, std::string>, Link>;  ///< by parent and child

  /// One step of a chain: T_before T_parent_child, or T_before T_parent_child^-1 if it is backward.
  struct Step {
    Links::const_iterator link;
    SE3 T_before;
    bool is_backward = false;

    const std::string& target() const { return is_backward ? link->first.first : link->first.second; }
    SE3 apply(const SE3& T_parent_child) const {
      return T_before * (is_backward ? T_parent_child.inverse() : T_parent_child);
    }
  };
  struct Chain {
    std::vector<Step> steps;
    SE3 T_behind;
  };

  std::optional<Step> step_over(const FrameTree& fixed, const std::string& from,
                                Links::const_iterator link) const;
  std::optional<Chain> find_chain(const FrameTree& fixed, const std::string& frame,
                                  const std::string& child) const;

  Links links_;
};

// Finds the static transforms of a ROS recording: those on topics called tf_static, and pairs of frames on
// any other transform topic whose value stays constant (many ROS 1 publishers repeat static transforms on
// /tf).
//
// A pair is constant if it has at least two messages and every T_parent_child is within 1e-6 (m, rad) of the
// first one. Values on tf_static take precedence over constant ones on other topics.
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
