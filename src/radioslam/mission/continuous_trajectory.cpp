#include "radioslam/mission/continuous_trajectory.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

/// Odometry from a keyframe to a time after it, and from there to the next keyframe.
template <class Pose>
struct SplitOdometry {
  OdometryEdge<Pose> part, rest;
};

/// Odometry between two keyframes that can be split at any time.
template <class Pose>
class OdometryBetweenKeyframes {
 public:
  OdometryBetweenKeyframes(const Robot& robot, Stamp begin, Stamp end)
      : robot_(robot), duration_s_(seconds_between(begin, end)) {
    const auto after = [](Stamp s, const auto& row) { return s < row.stamp; };
    const auto first = std::upper_bound(robot.odometry.begin(), robot.odometry.end(), begin, after);
    rows_.push_back({begin, *robot.odometry.at(begin)});
    for (auto row = first; row != robot.odometry.end() && row->stamp < end; ++row) rows_.push_back(*row);
    rows_.push_back({end, *robot.odometry.at(end)});
    from_begin_.resize(rows_.size());
    to_end_.resize(rows_.size());
    for (std::size_t i = 1; i < rows_.size(); ++i)
      from_begin_[i] = followed_by(from_begin_[i - 1], step(rows_[i - 1], rows_[i]));
    for (std::size_t i = rows_.size() - 1; i-- > 0;)
      to_end_[i] = followed_by(step(rows_[i], rows_[i + 1]), to_end_[i + 1]);
  }

  SplitOdometry<Pose> split_at(Stamp stamp) const {
    const auto after = std::upper_bound(rows_.begin() + 1, rows_.end() - 1, stamp,
                                        [](Stamp s, const auto& row) { return s < row.stamp; });
    const auto i = static_cast<std::size_t>(after - rows_.begin()) - 1;
    const StampedPose<SE3> here{stamp, *robot_.odometry.at(stamp)};
    return {followed_by(from_begin_[i], step(rows_[i], here)),
            followed_by(step(here, rows_[i + 1]), to_end_[i + 1])};
  }

 private:
  OdometryEdge<Pose> step(const StampedPose<SE3>& from, const StampedPose<SE3>& to) const {
    OdometryEdge<Pose> edge;
    append_sample(edge, from, to, robot_.odometry_noise);
    const double fraction = seconds_between(from.stamp, to.stamp) / duration_s_;
    edge.covariance.diagonal() += fraction * min_edge_variance<Pose>();
    return edge;
  }

  const Robot& robot_;
  double duration_s_;
  std::vector<StampedPose<SE3>> rows_;                   ///< samples, both keyframes' times included
  std::vector<OdometryEdge<Pose>> from_begin_, to_end_;  ///< per sample
};

/// Motion with a constant drift removed.
template <class Pose>
Pose without_drift(const OdometryEdge<Pose>& edge, const Eigen::Vector2d& drift) {
  return edge.T_i_j * Pose::exp(-edge.drift_jacobian * drift);
}

/// Evaluates the formulas of the header.
template <class Pose>
UncertainPose<Pose> pose_between(const Pose& T_k, const Pose& T_m, const SplitOdometry<Pose>& odometry,
                                 const Eigen::Vector2d& drift,
                                 const typename EstimatedKeyframes<Pose>::NeighbourCovariance* joint) {
  using Jacobian = typename Pose::Jacobian;
  using Tangent = typename Pose::Tangent;
  const Pose O_t = without_drift(odometry.part, drift), O_t_m = without_drift(odometry.rest, drift);
  const Pose T_k_m = T_k.inverse() * T_m;
  const Tangent d = ((O_t * O_t_m).inverse() * T_k_m).log();
  const Jacobian A = O_t_m.inverse().adjoint();
  const Jacobian AQ = A * odometry.part.covariance;
  const Jacobian Q_m = AQ * A.transpose() + odometry.rest.covariance;
  const Jacobian K = Cholesky<Jacobian>(Q_m).solve_matrix(AQ).transpose();
  const Tangent correction = K * d;
  const Pose T_k_t = O_t * Pose::exp(correction);
  const Jacobian bridge = odometry.part.covariance - K * AQ;
  UncertainPose<Pose> result{T_k * T_k_t, 0.5 * (bridge + bridge.transpose())};
  if (!joint) return result;
  const Jacobian M = Pose::right_jacobian(correction) * K * Pose::right_jacobian_inverse(d);
  Eigen::Matrix<double, Pose::kDof, 2 * Pose::kDof> J;
  J << T_k_t.inverse().adjoint() - M * T_k_m.inverse().adjoint(), M;
  result.covariance = congruence(J, *joint, result.covariance);
  return result;
}

}  // namespace

template <class Pose>
ContinuousTrajectory<Pose>::ContinuousTrajectory(const Robot& robot, EstimatedKeyframes<Pose> keyframes)
    : robot_(&robot), keyframes_(std::move(keyframes)) {
  const Trajectory<Pose>& poses = keyframes_.poses;
  RADIOSLAM_CHECK(!poses.empty(), "a trajectory needs a keyframe");
  RADIOSLAM_CHECK(robot.odometry.covers(poses.front().stamp) && robot.odometry.covers(poses.back().stamp),
                  "odometry must cover the keyframes");
  RADIOSLAM_CHECK(keyframes_.covariances.empty() || keyframes_.covariances.size() + 1 == poses.size(),
                  "one covariance per pair of consecutive keyframes");
}

template <class Pose>
std::optional<UncertainPose<Pose>> ContinuousTrajectory<Pose>::at(Stamp stamp) const {
  if (!covers(stamp)) return std::nullopt;
  return at(std::vector<Stamp>{stamp}).front();
}

template <class Pose>
std::vector<UncertainPose<Pose>> ContinuousTrajectory<Pose>::at(const std::vector<Stamp>& stamps) const {
  RADIOSLAM_CHECK(std::is_sorted(stamps.begin(), stamps.end()), "stamps must not decrease");
  RADIOSLAM_CHECK(stamps.empty() || (covers(stamps.front()) && covers(stamps.back())),
                  "keyframes must cover the stamps");
  const Trajectory<Pose>& poses = keyframes_.poses;
  std::vector<UncertainPose<Pose>> result;
  if (poses.size() == 1) {
    result.assign(stamps.size(), UncertainPose<Pose>{poses.front().pose});
    return result;
  }
  for (auto next = stamps.begin(); next != stamps.end();) {
    const std::size_t k = poses.segment(*next);
    const auto &before = poses[k], &after = poses[k + 1];
    const auto* joint = keyframes_.covariances.empty() ? nullptr : &keyframes_.covariances[k];
    const OdometryBetweenKeyframes<Pose> odometry(*robot_, before.stamp, after.stamp);
    for (; next != stamps.end() && (*next < after.stamp || k + 2 == poses.size()); ++next)
      result.push_back(
          pose_between(before.pose, after.pose, odometry.split_at(*next), keyframes_.drift, joint));
  }
  return result;
}

template class ContinuousTrajectory<SE2>;
template class ContinuousTrajectory<SE3>;

}  // namespace radioslam
