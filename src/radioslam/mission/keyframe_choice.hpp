// Keyframes one after another, as the robot chooses them on its way (keyframes.hpp).
#pragma once

#include <limits>
#include <vector>

#include "radioslam/mission/keyframe_motion.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// A time at which a robot measured something, and how well; zero: it is a keyframe in any case.
struct Occasion {
  Stamp stamp;
  double sigma_m = std::numeric_limits<double>::infinity(), sigma_rad = sigma_m;
};

Occasion occasion_of(Stamp stamp, const AoaPath& path);
Occasion occasion_of(Stamp stamp, const SE3::Jacobian& covariance);  ///< of a relative pose

class KeyframeChoice {
 public:
  /// Keeps references. `robot` has its odometry, at least from the last keyframe on and as far as an occasion
  /// needs it.
  KeyframeChoice(const Robot& robot, const KeyframeParams& params)
      : robot_(robot), params_(params), motion_(robot, keyframes_) {}
  KeyframeChoice(const KeyframeChoice&) = delete;
  KeyframeChoice& operator=(const KeyframeChoice&) = delete;

  /// The next sample of the odometry.
  void add(const StampedPose<SE3>& sample);
  /// An occasion between the last sample and the next one, which the robot has already.
  void add(const Occasion& occasion);
  /// The last sample is a keyframe, too.
  void finish();

  /// So far; later ones may be at the last sample or after it.
  const std::vector<Stamp>& keyframes() const { return keyframes_; }

 private:
  void add(Stamp stamp);
  bool is_better_than_odometry(const Occasion& occasion);
  void start(const StampedPose<SE3>& keyframe);
  void extend_way(const StampedPose<SE3>& sample);
  void bound_deviation(const StampedPose<SE3>& next);

  const Robot& robot_;
  const KeyframeParams& params_;
  std::vector<Stamp> keyframes_;
  StampedPose<SE3> last_;
  std::vector<StampedPose<SE3>> way_;  ///< from it; of samples close to each other, the first and last
  StampedPose<SE3> last_sample_;
  double farthest_ = 0;  ///< of it from the last keyframe, in allowances
  KeyframeMotion<SE3> motion_;
};

}  // namespace radioslam
