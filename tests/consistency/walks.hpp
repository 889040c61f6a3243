// Two simulated robots with noisy odometry, and true and false matches between them.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/consistency/odometry_chain.hpp"
#include "radioslam/consistency/pairwise.hpp"

namespace radioslam::test {

/// Standard normal tangent.
template <class Pose>
typename Pose::Tangent normal_tangent(Rng& rng) {
  typename Pose::Tangent xi;
  for (int k = 0; k < Pose::kDof; ++k) xi[k] = rng.normal();
  return xi;
}

/// A covariance with correlations: position and rotation off by about these sigmas.
template <class Pose>
typename Pose::Jacobian some_covariance(Rng& rng, double sigma_m, double sigma_rad) {
  typename Pose::Jacobian root;
  for (int k = 0; k < Pose::kDof; ++k) root.col(k) = 0.3 * normal_tangent<Pose>(rng);
  root += Pose::Jacobian::Identity();
  root.template topRows<Pose::kDim>() *= sigma_m;
  root.template bottomRows<Pose::kDof - Pose::kDim>() *= sigma_rad;
  return root * root.transpose();
}

/// Perturbed on the right.
template <class Pose>
Pose disturbed(Rng& rng, const Pose& pose, const typename Pose::Jacobian& covariance) {
  const typename Pose::Jacobian root = covariance.llt().matrixL();
  return pose * Pose::exp(root * normal_tangent<Pose>(rng));
}

/// One metre forward and a turn, per pose, from anywhere.
template <class Pose>
std::vector<Pose> true_walk(Rng& rng, std::size_t poses) {
  std::vector<Pose> walk{Pose::exp(10 * normal_tangent<Pose>(rng))};
  while (walk.size() < poses) {
    typename Pose::Tangent step = 0.1 * normal_tangent<Pose>(rng);
    step[0] += 1;
    walk.push_back(walk.back() * Pose::exp(step));
  }
  return walk;
}

/// Odometry of a trajectory with its true covariances.
template <class Pose>
OdometryChain<Pose> odometry_of(Rng& rng, const std::vector<Pose>& walk,
                                const std::vector<typename Pose::Jacobian>& covariances) {
  std::vector<Pose> chain(1);
  for (std::size_t k = 0; k + 1 < walk.size(); ++k)
    chain.push_back(chain.back() * disturbed<Pose>(rng, walk[k].inverse() * walk[k + 1], covariances[k]));
  return {chain, covariances};
}

template <class Pose>
struct TwoWalks {
  std::vector<Pose> a, b;
  std::vector<typename Pose::Jacobian> covariances_a, covariances_b;

  TwoWalks(Rng& rng, std::size_t poses, double sigma_m, double sigma_rad)
      : a(true_walk<Pose>(rng, poses)), b(true_walk<Pose>(rng, poses)) {
    for (std::size_t k = 0; k + 1 < poses; ++k) {
      covariances_a.push_back(some_covariance<Pose>(rng, sigma_m, sigma_rad));
      covariances_b.push_back(some_covariance<Pose>(rng, sigma_m, sigma_rad));
    }
  }

  OdometryChain<Pose> odometry_a(Rng& rng) const { return odometry_of<Pose>(rng, a, covariances_a); }
  OdometryChain<Pose> odometry_b(Rng& rng) const { return odometry_of<Pose>(rng, b, covariances_b); }

  RelativePoseMatch<Pose> true_match(Rng& rng, std::size_t i, std::size_t j, double sigma_m,
                                     double sigma_rad) const {
    const auto covariance = some_covariance<Pose>(rng, sigma_m, sigma_rad);
    return {i, j, disturbed<Pose>(rng, a[i].inverse() * b[j], covariance), covariance};
  }
};

}  // namespace radioslam::test
