// Covariances of skeleton poses and drifts, within a segment and between the segments of two robots (left
// perturbations eta = Ad(T) xi in a shifted frame; see overlap_joint.hpp).
#pragma once

#include <atomic>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "radioslam/closure/overlap/keyframe_skeleton.hpp"
#include "radioslam/closure/overlap/overlap_relative.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {

/// Variables of a segment, [eta_c1, eta_c2, drift], in the reduced graph.
struct SegmentVariables {
  PoseId first, last;
  DriftId drift{};
};

/// Inverse of the reduced graph's information matrix. Solves must run in one thread at a time.
template <class Pose>
class SkeletonCovariance {
 public:
  static constexpr int kDof = Pose::kDof, kSize = 2 * kDof + 2;  ///< dimension of a segment's variables
  using Joint = Eigen::Matrix<double, kSize, kSize>;

  /// Nothing if some variable is unobservable. Frames are shifted by `origin`.
  static std::shared_ptr<const SkeletonCovariance> compute(
      PoseGraph<Pose> reduced, const typename Pose::Point& origin,
      std::vector<std::vector<SegmentVariables>> segments);

  const std::vector<SegmentVariables>& segments(std::size_t robot) const { return segments_[robot]; }
  Joint within(const SegmentVariables& segment) const;
  /// Cov(rows, v), stacked, followed by two rows of zeros for segments without a drift.
  Eigen::MatrixXd columns(const Variable& v, const std::vector<Variable>& rows) const;
  /// Keeps the columns solved from now on, up to so many scalars in all, and forgets those kept before: pairs
  /// of robots that are searched one after the other often share one.
  void keep_columns(std::size_t robot, std::size_t scalars) const;
  static constexpr Eigen::Index size(const Variable& v) { return v.kind == VariableKind::kPose ? kDof : 2; }

 private:
  SkeletonCovariance(PoseGraph<Pose> reduced, const typename Pose::Point& origin)
      : graph_(std::move(reduced)), equations_(graph_), origin_(origin) {}

  Eigen::MatrixXd block(const Variable& a, const Variable& b) const;
  Eigen::MatrixXd to_left(const Variable& v) const;
  /// Columns of the inverse of the variable with this block.
  Eigen::MatrixXd inverse_columns(std::size_t block) const;

  PoseGraph<Pose> graph_;
  NormalEquations<Pose> equations_;
  std::optional<SelectedInverse> inverse_;
  typename Pose::Point origin_;
  std::vector<std::vector<SegmentVariables>> segments_;
  mutable std::optional<std::size_t> kept_robot_;
  mutable std::size_t free_scalars_ = 0;
  mutable std::unordered_map<std::size_t, Eigen::MatrixXd> kept_;  ///< by block
};

/// Covariances between robot a's and robot b's segments, solved for on demand. Thread-safe.
template <class Pose>
class CrossCovariance {
 public:
  static constexpr int kDof = Pose::kDof, kSize = 2 * kDof + 2;
  using Joint = Eigen::Matrix<double, kSize, kSize>;

  CrossCovariance(std::shared_ptr<const SkeletonCovariance<Pose>> skeleton, std::size_t a, std::size_t b,
                  std::size_t dense_scalars);

  /// Cov(variables of segment t of b, variables of segment s of a).
  Joint between(std::size_t s, std::size_t t) const;
  /// Number of a's segments whose columns are cached at the same time.
  std::size_t cached_segments() const { return capacity_; }

 private:
  using Columns = std::shared_ptr<const Eigen::MatrixXd>;
  using Latest = std::list<std::pair<std::size_t, Columns>>;
  /// Variables of a segment as indices into a list of variables.
  struct Places {
    std::size_t first, last, drift;
  };
  /// Variables of a robot's segments, each once; a segment without a drift has the index past the last.
  struct Listed {
    std::vector<Variable> variables;
    std::vector<Places> segments;
  };
  static Listed list_variables(const std::vector<SegmentVariables>& segments);

  const Eigen::MatrixXd& kept(std::size_t variable) const;
  Columns latest(std::size_t variable) const;

  std::shared_ptr<const SkeletonCovariance<Pose>> skeleton_;
  Listed a_, b_;
  std::vector<Eigen::Index> rows_b_;  ///< of b's variables
  std::size_t capacity_ = 0;          ///< number of pose columns that fit into the cache
  bool all_fit_ = false;              ///< no column is ever evicted
  mutable std::vector<std::atomic<const Eigen::MatrixXd*>>
      solved_;  ///< per variable of a, and one for no drift
  mutable std::deque<Eigen::MatrixXd> store_;
  mutable std::mutex mutex_;
  mutable Latest latest_;  ///< most recently used first
  mutable std::unordered_map<std::size_t, typename Latest::iterator> place_;
};

}  // namespace radioslam
