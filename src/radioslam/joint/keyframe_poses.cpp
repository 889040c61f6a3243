#include "radioslam/joint/keyframe_poses.hpp"

namespace radioslam {

template <class Pose>
KeyframePoses<Pose>::KeyframePoses(const JointGraph<Pose>& joint, const Mission& mission)
    : mission_(mission), robots_(mission.robots.size()) {
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p) {
    const std::size_t r = joint.robot_of_segment[p];
    if (mission.robots[r].odometry.empty()) continue;
    robots_[r].segment = &joint.team.segments[p];
    robots_[r].motion.emplace(mission.robots[r], joint.team.segments[p].stamps);
  }
}

template <class Pose>
std::optional<AfterKeyframe<Pose>> KeyframePoses<Pose>::at(RobotIndex robot, Stamp stamp) {
  OfRobot& of = robots_[robot.index()];
  if (!of.segment || !mission_.robots[robot.index()].odometry.covers(stamp)) return std::nullopt;
  AfterKeyframe<Pose> result;
  result.motion = of.motion->at(stamp);
  result.pose = PoseId(of.segment->first_pose + result.motion.keyframe);
  result.keyframe = of.segment->stamps[result.motion.keyframe];
  result.after_ns = stamp.ns - result.keyframe.ns;
  return result;
}

template class KeyframePoses<SE2>;
template class KeyframePoses<SE3>;

}  // namespace radioslam
