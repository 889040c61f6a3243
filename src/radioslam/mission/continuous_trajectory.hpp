// Where a robot was at any time, from the estimated poses of its keyframes and its odometry in between: a
// Gaussian process whose mean is the odometry and whose kernel is the odometry's random walk, conditioned on
// both keyframes around. What the estimate moved them apart, by closures, say, is spread over the way between
// them as the odometry's noise grew along it.
//
//   k, m  the keyframes before and after t      O_t, O_t_m  motion by odometry from k to t, from t to m
//   Q_t, Q_t_m  their covariances               O_m = O_t O_t_m,  Q_m = A Q_t A^T + Q_t_m
//   A = Ad(O_t_m^-1)                            carries an error at t to m
//   d = Log(O_m^-1 T_k^-1 T_m)                  what the estimate says beyond the odometry
//   K = Q_t A^T Q_m^-1                          0 at k, 1 at m
//   T_t = T_k O_t Exp(K d)
//   covariance = (Q_t - K A Q_t) + J S J^T      S: joint covariance of T_k and T_m, 12 x 12 (6 x 6 in the
//   plane) J = [Ad((O_t Exp(K d))^-1) - M Ad(T_m^-1 T_k), M],  M = J_r(K d) K J_r^-1(d)
//
// which is what the graph itself would say of a pose at t tied by odometry to both keyframes (J_r: the
// group's right Jacobian; without a joint covariance the first part is left, the error relative to the
// keyframes). A constant drift of the odometry, where one was estimated, is taken out of O_t first. The floor
// that odometry_edge.hpp adds to an edge grows evenly in time from k to m. Between the odometry's rows the
// motion goes on evenly (Trajectory::at). Cost: linear in rows and times for times in order; the rows between
// two keyframes for a single one.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// A robot's keyframes as estimated.
template <class Pose>
struct EstimatedKeyframes {
  /// For perturbations on the right of [T_k; T_(k+1)].
  using NeighbourCovariance = Eigen::Matrix<double, 2 * Pose::kDof, 2 * Pose::kDof>;

  Trajectory<Pose> poses;                           ///< at least one, at times that the odometry covers
  std::vector<NeighbourCovariance> covariances;     ///< of each with the next; empty: not known
  Eigen::Vector2d drift = Eigen::Vector2d::Zero();  ///< of the odometry: yaw (rad/m), relative scale error
};

template <class Pose>
class ContinuousTrajectory {
 public:
  /// `robot` must stay.
  ContinuousTrajectory(const Robot& robot, EstimatedKeyframes<Pose> keyframes);

  const Trajectory<Pose>& keyframes() const { return keyframes_.poses; }
  bool covers(Stamp stamp) const { return keyframes_.poses.covers(stamp); }

  /// Nothing before the first and after the last keyframe.
  std::optional<UncertainPose<Pose>> at(Stamp stamp) const;
  /// At times that do not decrease and are all covered.
  std::vector<UncertainPose<Pose>> at(const std::vector<Stamp>& stamps) const;

 private:
  const Robot* robot_;
  EstimatedKeyframes<Pose> keyframes_;
};

}  // namespace radioslam
