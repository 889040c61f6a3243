#include "radioslam/mission/keyframe_motion.hpp"

#include <algorithm>

#include "radioslam/mission/keyframes.hpp"

namespace radioslam {

template <class Pose>
MotionSinceKeyframe<Pose> KeyframeMotion<Pose>::at(Stamp stamp) {
  const Trajectory<SE3>& odometry = robot_.odometry;
  const std::size_t keyframe = keyframe_before(keyframes_, stamp);
  if (!is_begun_ || since_ != keyframes_[keyframe] || stamp < reached_.stamp) {
    is_begun_ = true;
    since_ = keyframes_[keyframe];
    reached_ = {since_, *odometry.at(since_)};
    edge_ = {};
  }
  auto next = std::upper_bound(odometry.begin(), odometry.end(), reached_.stamp,
                               [](Stamp at, const auto& sample) { return at < sample.stamp; });
  for (; next != odometry.end() && next->stamp <= stamp; ++next) {
    append_sample(edge_, reached_, *next, robot_.odometry_noise);
    reached_ = *next;
  }
  OdometryEdge<Pose> edge = edge_;
  if (reached_.stamp < stamp)
    append_sample(edge, reached_, {stamp, *odometry.at(stamp)}, robot_.odometry_noise);
  return {keyframe, with_drift(edge, robot_.odometry_noise)};
}

template class KeyframeMotion<SE2>;
template class KeyframeMotion<SE3>;

}  // namespace radioslam
