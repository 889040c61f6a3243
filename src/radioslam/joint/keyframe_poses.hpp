// A robot of the joint graph at any time: a pose of the graph and the odometry since. Measurements between
// keyframes hang on the one before them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/mission/keyframe_motion.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

template <class Pose>
struct AfterKeyframe {
  PoseId pose;
  Stamp keyframe;
  MotionSinceKeyframe<Pose> motion;
  std::int64_t after_ns = 0;  ///< since the keyframe
};

template <class Pose>
class KeyframePoses {
 public:
  /// Of a mission, where a robot has one segment. Both are kept by reference; the segments must stay.
  KeyframePoses(const JointGraph<Pose>& joint, const Mission& mission);

  /// Nothing outside the robot's odometry.
  std::optional<AfterKeyframe<Pose>> at(RobotIndex robot, Stamp stamp);

 private:
  struct OfRobot {
    const TrajectorySegment* segment = nullptr;
    std::optional<KeyframeMotion<Pose>> motion;
  };
  const Mission& mission_;
  std::vector<OfRobot> robots_;
};

}  // namespace radioslam
