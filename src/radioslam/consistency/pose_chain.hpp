// One trajectory as relative poses between any two of its poses, with covariances: by odometry alone
// (odometry_chain.hpp), or corrected by the robot's own loops.
#pragma once

#include <cstddef>

#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {

template <class Pose>
class PoseChain {
 public:
  virtual ~PoseChain() = default;

  virtual std::size_t size() const = 0;
  /// T_i_j.
  virtual Pose increment(std::size_t i, std::size_t j) const = 0;
  /// Of T_i_j, right perturbation.
  virtual typename Pose::Jacobian increment_covariance(std::size_t i, std::size_t j) const = 0;

  UncertainPose<Pose> between(std::size_t i, std::size_t j) const {
    return {increment(i, j), increment_covariance(i, j)};
  }
};

}  // namespace radioslam
