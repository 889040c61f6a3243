// Covariances of the skeleton's poses (left perturbations eta = Ad(T) xi in a shifted frame) and drifts:
// within a stretch, and between the stretches of two robots. See overlap_joint.hpp.
#pragma once

#include <atomic>
#include <deque>
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
  /// Cov(rows, v), one after the other, and two rows of zeros for stretches without a drift.
  Eigen::MatrixXd columns(const Variable& v, const std::vector<Variable>& rows) const;
  static constexpr Eigen::Index size(const Variable& v) { return v.kind == VariableKind::kPose ? kDof : 2; }

 private:
  SkeletonCovariance(PoseGraph<Pose> reduced, const typename Pose::Point& origin)
      : graph_(std::move(reduced)), equations_(graph_), origin_(origin) {}

  Eigen::MatrixXd block(const Variable& a, const Variable& b) const;
  Eigen::MatrixXd to_left(const Variable& v) const;

  PoseGraph<Pose> graph_;
  NormalEquations<Pose> equations_;
  std::optional<SelectedInverse> inverse_;
  typename Pose::Point origin_;
  std::vector<std::vector<StretchVariables>> stretches_;
};

/// Between robot a's stretches and robot b's, solved for when asked. Any number of threads.
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
  using Latest = std::list<std::pair<std::size_t, Columns>>;
  /// A stretch's variables, by their places in a list of variables.
  struct Places {
    std::size_t first, last, drift;
  };
  /// The variables of a robot's stretches, each once; a stretch without a drift has the place after the last.
  struct Listed {
    std::vector<Variable> variables;
    std::vector<Places> stretches;
  };
  static Listed list_variables(const std::vector<StretchVariables>& stretches);

  const Eigen::MatrixXd& kept(std::size_t variable) const;
  Columns latest(std::size_t variable) const;

  std::shared_ptr<const SkeletonCovariance<Pose>> skeleton_;
  Listed a_, b_;
  std::vector<Eigen::Index> rows_b_;                                 ///< of b's variables
  std::size_t capacity_ = 0;                                         ///< columns of poses that are kept
  bool all_fit_ = false;                                             ///< what was solved for once stays
  mutable std::vector<std::atomic<const Eigen::MatrixXd*>> solved_;  ///< per variable of a and no drift
  mutable std::deque<Eigen::MatrixXd> store_;
  mutable std::mutex mutex_;
  mutable Latest latest_;  ///< the latest first
  mutable std::unordered_map<std::size_t, typename Latest::iterator> place_;
};

}  // namespace radioslam
