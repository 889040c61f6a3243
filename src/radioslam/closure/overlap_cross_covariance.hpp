// Covariances of the skeleton's poses (left perturbations eta = Ad(T) xi in a shifted frame) and drifts:
// within a stretch, and between the stretches of two robots. See overlap_joint.hpp.
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "radioslam/closure/overlap_skeleton.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {

/// A stretch's variables [eta_c1, eta_c2, drift], each a variable of the reduced graph.
struct StretchVariables {
  PoseId first, last;
  DriftId drift{};
};

/// The reduced graph's inverse. Its solves are for one thread at a time.
template <class Pose>
class SkeletonCovariance {
 public:
  static constexpr int kDof = Pose::kDof, kSize = 2 * kDof + 2;  ///< of a stretch's variables
  using Joint = Eigen::Matrix<double, kSize, kSize>;

  /// Nothing when the graph leaves something unobserved. Frames are shifted by `origin`.
  static std::shared_ptr<const SkeletonCovariance> compute(
      PoseGraph<Pose> reduced, const typename Pose::Point& origin,
      std::vector<std::vector<StretchVariables>> stretches);

  const std::vector<StretchVariables>& stretches(std::size_t robot) const { return stretches_[robot]; }
  Joint within(const StretchVariables& stretch) const;
  /// Cov([every stretch end and drift of `rows`], [the stretch's variables]): see CrossCovariance.
  Eigen::MatrixXd columns(const StretchVariables& stretch, const std::vector<Variable>& rows) const;

 private:
  SkeletonCovariance(PoseGraph<Pose> reduced, const typename Pose::Point& origin)
      : graph_(std::move(reduced)), equations_(graph_), origin_(origin) {}

  Eigen::MatrixXd block(const Variable& a, const Variable& b) const;
  Eigen::MatrixXd to_left(const Variable& v) const;
  static Eigen::Index size(const Variable& v) { return v.kind == VariableKind::kPose ? kDof : 2; }

  PoseGraph<Pose> graph_;
  NormalEquations<Pose> equations_;
  std::optional<SelectedInverse> inverse_;
  typename Pose::Point origin_;
  std::vector<std::vector<StretchVariables>> stretches_;
};

/// Between robot a's stretches and robot b's. Any number of threads.
template <class Pose>
class CrossCovariance {
 public:
  static constexpr int kDof = Pose::kDof, kSize = 2 * kDof + 2;
  using Joint = Eigen::Matrix<double, kSize, kSize>;

  CrossCovariance(std::shared_ptr<const SkeletonCovariance<Pose>> skeleton, std::size_t a, std::size_t b,
                  std::size_t dense_scalars);

  /// Cov(variables of stretch t of b, variables of stretch s of a).
  Joint between(std::size_t s, std::size_t t) const;
  /// How many of a's stretches can be looked at in turn without solving again.
  std::size_t stretches_at_hand() const { return capacity_; }

 private:
  using Columns = std::shared_ptr<const Eigen::MatrixXd>;
  struct Rows {
    Eigen::Index first, last, drift;
  };
  Columns columns(std::size_t s) const;
  Columns latest(std::size_t s) const;

  std::shared_ptr<const SkeletonCovariance<Pose>> skeleton_;
  std::size_t a_;
  std::vector<Variable> variables_b_;
  std::vector<Rows> rows_b_;
  std::size_t capacity_ = 0;
  std::vector<Columns> all_;  ///< empty when they do not fit
  mutable std::mutex mutex_;
  mutable std::list<std::pair<std::size_t, Columns>> latest_;  ///< the latest first
  mutable std::unordered_map<std::size_t, typename std::list<std::pair<std::size_t, Columns>>::iterator>
      place_;
};

}  // namespace radioslam
