// A robot's odometry between any two of its poses, value and covariance, in O(1) from prefix sums.
// With perturbations on the left, T <- Exp(eta) T, odometry adds up:
//   eta_j - eta_i has covariance S_j - S_i for i <= j,  S_j = sum over k < j of Ad(T_k+1) Q_k Ad(T_k+1)^T,
// Q_k being the covariance of the increment T_k^-1 T_k+1 (right perturbation). The increment T_i^-1 T_j, in
// either direction, has the right-perturbation covariance Ad(T_j^-1) (S_max - S_min) Ad(T_j^-1)^T.
// The difference of sums cancels; the frame's origin is moved to the middle of the poses and the sums are
// compensated, so what is lost is a few units in the last place of (half the extent)^2 * variance of yaw.
// One chain is one gapless segment of odometry: a new chain begins after a gap.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "radioslam/base/check.hpp"
#include "radioslam/consistency/pose_chain.hpp"
#include "radioslam/geometry/compensated_sum.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

template <class Pose>
class OdometryChain final : public PoseChain<Pose> {
 public:
  using Jacobian = typename Pose::Jacobian;

  /// `poses` are T_start_k, one at least; `step_covariances[k]` is that of T_k^-1 T_k+1.
  OdometryChain(std::vector<Pose> poses, const std::vector<Jacobian>& step_covariances)
      : poses_(std::move(poses)) {
    RADIOSLAM_CHECK(!poses_.empty() && step_covariances.size() + 1 == poses_.size(),
                    "a chain has one step less than poses");
    centre();
    CompensatedSum<Jacobian> sum;
    sums_.push_back(sum.value());
    for (std::size_t k = 0; k < step_covariances.size(); ++k) {
      const Jacobian ad = poses_[k + 1].adjoint();
      sum.add(congruence(ad, step_covariances[k]));
      sums_.push_back(sum.value());
    }
  }

  std::size_t size() const override { return poses_.size(); }

  /// T_i_j.
  Pose increment(std::size_t i, std::size_t j) const override { return poses_[i].inverse() * poses_[j]; }

  /// Of T_i_j, right perturbation.
  Jacobian increment_covariance(std::size_t i, std::size_t j) const override {
    const Jacobian ad = poses_[j].inverse().adjoint();
    return congruence<Jacobian, Jacobian>(ad, sums_[std::max(i, j)] - sums_[std::min(i, j)]);
  }

 private:
  void centre() {
    typename Pose::Point middle = Pose::Point::Zero();
    for (const Pose& pose : poses_) middle += pose.translation() / static_cast<double>(poses_.size());
    typename Pose::Tangent shift = Pose::Tangent::Zero();
    shift.template head<Pose::kDim>() = -middle;
    for (Pose& pose : poses_) pose = Pose::exp(shift) * pose;
  }

  std::vector<Pose> poses_;
  std::vector<Jacobian> sums_;
};

}  // namespace radioslam
