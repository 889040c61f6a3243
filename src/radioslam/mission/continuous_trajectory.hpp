// Continuous-time trajectory: pose and covariance of a robot at any time, from its estimated keyframes and
// the odometry between them. A Gaussian process whose mean is the odometry and whose kernel is the odometry's
// random walk, conditioned on the keyframes before and after: corrections of the keyframes (by closures, for
// example) are distributed along the path in proportion to the odometry's accumulated noise.
//
//   k, m  the keyframes before and after t      O_t, O_t_m  motion by odometry from k to t, from t to m
//   Q_t, Q_t_m  their covariances               O_m = O_t O_t_m,  Q_m = A Q_t A^T + Q_t_m
//   A = Ad(O_t_m^-1)                            propagates an error at t to m
//   d = Log(O_m^-1 T_k^-1 T_m)                  correction of the odometry by the estimate
//   K = Q_t A^T Q_m^-1                          0 at k, 1 at m
//   T_t = T_k O_t Exp(K d)
//   covariance = (Q_t - K A Q_t) + J S J^T,     S: joint covariance of T_k and T_m (12 x 12; 6 x 6 in the
//   plane) J = [Ad((O_t Exp(K d))^-1) - M Ad(T_m^-1 T_k), M],  M = J_r(K d) K J_r^-1(d)     (J_r: right
//   Jacobian)
//
// This equals the graph's own estimate of a pose at t that has odometry factors to both keyframes. Without a
// joint covariance only the first term is returned, the error relative to the keyframes. An estimated
// constant odometry drift is first removed from O_t. The variance floor that odometry_edge.hpp adds to an
// edge grows linearly in time from k to m. Between odometry samples the motion is interpolated
// (Trajectory::at). Cost: linear in samples and times for ordered times; the samples between two keyframes
// for a single time.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Estimated keyframes of a robot.
template <class Pose>
struct EstimatedKeyframes {
  /// Joint covariance of [T_k; T_(k+1)], right perturbations.
  using NeighbourCovariance = Eigen::Matrix<double, 2 * Pose::kDof, 2 * Pose::kDof>;

  Trajectory<Pose> poses;                           ///< at least one, at times covered by the odometry
  std::vector<NeighbourCovariance> covariances;     ///< of each keyframe with the next; empty: unknown
  Eigen::Vector2d drift = Eigen::Vector2d::Zero();  ///< of the odometry: yaw (rad/m), relative scale error
};

template <class Pose>
class ContinuousTrajectory {
 public:
  /// `robot` must outlive this object.
  ContinuousTrajectory(const Robot& robot, EstimatedKeyframes<Pose> keyframes);

  const Trajectory<Pose>& keyframes() const { return keyframes_.poses; }
  bool covers(Stamp stamp) const { return keyframes_.poses.covers(stamp); }

  /// Nothing before the first or after the last keyframe.
  std::optional<UncertainPose<Pose>> at(Stamp stamp) const;
  /// `stamps` must be non-decreasing and covered.
  std::vector<UncertainPose<Pose>> at(const std::vector<Stamp>& stamps) const;

 private:
  const Robot* robot_;
  EstimatedKeyframes<Pose> keyframes_;
};

}  // namespace radioslam
