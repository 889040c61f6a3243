// Interface between the overlap search and an estimate, and the algebra that both kinds of estimate
// (overlap_link.hpp, overlap_joint.hpp) have in common.
//
// Perturbations here are on the LEFT, T <- Exp(eta) T, with eta = Ad(T) xi for the right perturbation xi =
// [translation, rotation] of the rest of the program: odometry noise then adds up, eta_l - eta_k = sum of the
// steps' noise, and the position of l seen from k depends on that difference alone. In the axes of the common
// frame
//   d(p_l - p_k seen from k) = J(p_l) (eta_l - eta_k),   J(p) = [I, w -> w x p],
// so the covariance in frame k, R_kl S_tt R_kl^T for the composed right-perturbation covariance S, equals
// J(p_l) Cov(eta_l - eta_k) J(p_l)^T rotated by R_k^T. Overlap distances (overlap_distance.hpp) are invariant
// to that rotation and computed without it. Frames are first shifted to the mean of the poses, since eta
// grows with the distance from the origin.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

/// Poses [begin, end) of a robot.
struct PoseInterval {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

/// The poses that are in both.
inline PoseInterval common(const PoseInterval& p, const PoseInterval& q) {
  const std::size_t begin = std::max(p.begin, q.begin);
  return {begin, std::max(begin, std::min(p.end, q.end))};
}

/// Upper bounds of the standard deviations of one pose relative to another of the same robot, rounding
/// included.
struct PoseSpread {
  double sigma_m = 0;
  double sigma_rad = 0;

  void widen(const PoseSpread& other) {
    sigma_m = std::max(sigma_m, other.sigma_m);
    sigma_rad = std::max(sigma_rad, other.sigma_rad);
  }
};

/// Pose l seen from pose k, in the axes of the common frame.
template <class Pose>
struct RelativePosition {
  typename Pose::Point difference_m;   ///< p_l - p_k
  typename Pose::Jacobian covariance;  ///< of that difference, and of the rotation between the two
};

/// [I, w -> w x p; 0, I]: motion of the point p and of the axes under eta.
template <class Pose>
typename Pose::Jacobian motion_at(const typename Pose::Point& p) {
  typename Pose::Jacobian j = Pose::Jacobian::Identity();
  if constexpr (Pose::kDim == 2) {
    j(0, 2) = -p.y();
    j(1, 2) = p.x();
  } else {
    j(0, 4) = p.z(), j(0, 5) = -p.y();
    j(1, 3) = -p.z(), j(1, 5) = p.x();
    j(2, 3) = p.y(), j(2, 4) = -p.x();
  }
  return j;
}

template <class Pose>
auto position_block(const typename Pose::Jacobian& covariance) {
  return covariance.template topLeftCorner<Pose::kDim, Pose::kDim>();
}
template <class Pose>
auto rotation_block(const typename Pose::Jacobian& covariance) {
  constexpr int kRotation = Pose::kDof - Pose::kDim;
  return covariance.template bottomRightCorner<kRotation, kRotation>();
}

/// Upper bound of the largest standard deviation: square root of the Frobenius norm.
inline double sigma_bound(const auto& covariance) { return std::sqrt(covariance.norm()); }

template <class Pose>
PoseSpread spread_of(const typename Pose::Jacobian& covariance) {
  return {sigma_bound(position_block<Pose>(covariance)), sigma_bound(rotation_block<Pose>(covariance))};
}

/// The matrix with its upper triangle copied from the lower one.
template <class Matrix>
Matrix mirrored(const Matrix& covariance) {
  return covariance.template selfadjointView<Eigen::Lower>();
}

/// The pose in a frame whose origin is moved to `origin`.
inline SE2 shifted(const SE2& pose, const Eigen::Vector2d& origin) {
  return {pose.translation() - origin, pose.angle()};
}
inline SE3 shifted(const SE3& pose, const Eigen::Vector3d& origin) {
  return {pose.translation() - origin, pose.rotation()};
}

inline double rotation_of(const SE2& pose) { return pose.angle(); }
inline const Eigen::Quaterniond& rotation_of(const SE3& pose) { return pose.rotation(); }

inline double heading(const SE2& pose) { return pose.angle(); }
inline double heading(const SE3& pose) { return pose.yaw(); }

template <class Pose>
typename Pose::Point middle_of(const std::vector<Pose>& poses) {
  typename Pose::Point sum = Pose::Point::Zero();
  for (const Pose& pose : poses) sum += pose.translation();
  return poses.empty() ? sum : typename Pose::Point(sum / static_cast<double>(poses.size()));
}

/// What two robots must know to compare their poses. A "tie" is one link (mode link) or the joint estimate as
/// a whole (mode joint). A record holds the data of one pose, in its robot's shifted frame.
template <class V>
concept OverlapView = requires(const V& view, const typename V::Record& k, std::size_t tie,
                               double travelled_m) {
  typename V::Pose;
  { k.position_m } -> std::convertible_to<typename V::Pose::Point>;
  { k.heading_rad } -> std::convertible_to<double>;
  { k.travelled_m } -> std::convertible_to<double>;
  { view.ties() } -> std::convertible_to<std::size_t>;
  { view.in_a(tie, k.position_m) } -> std::convertible_to<typename V::Pose::Point>;  // from b's frame
  { view.turn_in_a(tie) } -> std::convertible_to<double>;  // rotation from b's frame to a's
  // Half extents, along a's axes, of a box that encloses a box with these half extents along b's axes.
  { view.half_extent_in_a(tie, k.position_m) } -> std::convertible_to<typename V::Pose::Point>;
  { view.relative(tie, k, k) } -> std::convertible_to<RelativePosition<typename V::Pose>>;
  {
    view.link_travelled_a(tie)
    } -> std::convertible_to<double>;  // path length at the link's end on a, metres
  { view.link_travelled_b(tie) } -> std::convertible_to<double>;
};

/// One robot's poses, as it knows them itself: no pose of another robot is in them.
template <class P>
concept OverlapPoses = OverlapView<typename P::View> && requires(const P& poses, std::size_t k) {
  { poses.records()[k] } -> std::convertible_to<typename P::View::Record>;
  { poses.pieces()[k] } -> std::convertible_to<PoseInterval>;  // intervals connected by odometry
  // Of an interval: intervals of two robots are compared if they are in the same one.
  { poses.component(k) } -> std::convertible_to<std::uint32_t>;
  { poses.spread(k, k) } -> std::convertible_to<PoseSpread>;  // (pose, middle pose)
};

/// Estimate of a team as required by the search: each robot's poses, and what all robots know to compare
/// them. Robots are numbered in the order of the mission.
template <class S>
concept OverlapSource = OverlapPoses<typename S::Poses> &&
    requires(const S& source, const typename S::Team& team, const typename S::Poses& poses,
             std::size_t robot) {
  { source.robots() } -> std::convertible_to<std::size_t>;
  { source.poses(robot) } -> std::convertible_to<const typename S::Poses&>;
  { source.team() } -> std::convertible_to<const typename S::Team&>;
  // Runs of robot a's poses that are compared with all later robots, with what is kept meanwhile.
  { team.runs(robot, poses)[0] } -> std::convertible_to<PoseInterval>;
  {
    team.view(robot, robot, team.columns(robot, poses, team.runs(robot, poses)[0]))
    } -> std::convertible_to<typename S::Poses::View>;  // of robots a < b
};

}  // namespace radioslam
