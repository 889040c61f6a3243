// A robot at any time: the last keyframe before, and the odometry since.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {

template <class Pose>
struct MotionSinceKeyframe {
  std::size_t keyframe = 0;
  UncertainPose<Pose> T_keyframe_body;  ///< exact at the keyframe itself

  /// Mean variance of a position, and of a direction, that is measured there.
  double position_m2() const {
    return T_keyframe_body.covariance.diagonal().template head<Pose::kDim>().mean();
  }
  double rotation_rad2() const {
    return T_keyframe_body.covariance.diagonal().template tail<Pose::kDof - Pose::kDim>().mean();
  }
};

/// Of one robot. Any order of the times is possible; of increasing ones the cost is linear in the samples.
template <class Pose>
class KeyframeMotion {
 public:
  /// Both are kept by reference. Keyframes are within the odometry; later ones may follow.
  KeyframeMotion(const Robot& robot, const std::vector<Stamp>& keyframes)
      : robot_(robot), keyframes_(keyframes) {}

  /// At a time that the odometry covers, not before the first keyframe.
  MotionSinceKeyframe<Pose> at(Stamp stamp);

 private:
  const Robot& robot_;
  const std::vector<Stamp>& keyframes_;
  Stamp since_;
  StampedPose<SE3> reached_;  ///< the keyframe, or the last sample that `edge_` leads to
  OdometryEdge<Pose> edge_;
  bool is_begun_ = false;
};

}  // namespace radioslam
