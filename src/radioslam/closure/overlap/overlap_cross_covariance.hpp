// Covariances of skeleton poses and drifts, within a segment and between the segments of two robots (left
// perturbations eta = Ad(T) xi in a shifted frame; see overlap_joint.hpp).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "radioslam/closure/overlap/keyframe_skeleton.hpp"
#include "radioslam/closure/overlap/overlap_relative.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {

/// The index of a drift that is not there.
inline constexpr std::size_t kNoDrift = ~std::size_t{0};

/// Variables of a segment as indices into a list.
struct SegmentPlaces {
  std::size_t first = 0, last = 0, drift = 0;
};

/// Variables of a segment, [eta_c1, eta_c2, drift], in the reduced graph.
struct SegmentVariables {
  PoseId first, last;
  DriftId drift{};
};

/// Inverse of the reduced graph's information matrix. Thread-safe.
template <class Pose>
class SkeletonCovariance {
 public:
  static constexpr int kDof = Pose::kDof, kSize = 2 * kDof + 2;  ///< dimension of a segment's variables
  using Joint = Eigen::Matrix<double, kSize, kSize>;

  /// A variable of a robot's segments.
  struct Listed {
    Variable variable;
    std::size_t block = 0, part = 0;
    const double* by_boundary = nullptr;  ///< boundary of its part x size
    Eigen::Index boundary = 0, local_column = 0;
    bool is_free = false, is_separator = false;
    Eigen::Matrix<double, kDof, kDof> to_left;  ///< of a pose
  };

  /// Nothing if some variable is unobservable. Frames are shifted by `origin`.
  static std::shared_ptr<SkeletonCovariance> compute(PoseGraph<Pose> reduced,
                                                     const typename Pose::Point& origin,
                                                     std::vector<std::vector<SegmentVariables>> segments);

  std::size_t robots() const { return segments_.size(); }
  const std::vector<SegmentVariables>& segments(std::size_t robot) const { return segments_[robot]; }
  /// A robot's variables, each once.
  const std::vector<Listed>& listed(std::size_t robot) const { return listed_[robot]; }
  /// Those of a segment, as indices into the list.
  const SegmentPlaces& places(std::size_t robot, std::size_t segment) const {
    return places_[robot][segment];
  }
  Joint within(const SegmentVariables& segment) const;
  /// Frees what `within` takes, which must not be called any more.
  void forget_segments() { inverse_.reset(); }
  /// Nothing if no variable is free.
  const std::optional<PartitionedInverse>& parts() const { return parts_; }
  static constexpr Eigen::Index size(const Variable& v) { return v.kind == VariableKind::kPose ? kDof : 2; }

 private:
  SkeletonCovariance(PoseGraph<Pose> reduced, const typename Pose::Point& origin)
      : graph_(std::move(reduced)), equations_(graph_), origin_(origin) {}

  Eigen::MatrixXd block(const Variable& a, const Variable& b) const;
  Eigen::MatrixXd to_left(const Variable& v) const;
  void list_variables();

  PoseGraph<Pose> graph_;
  NormalEquations<Pose> equations_;
  std::optional<SelectedInverse> inverse_;
  std::optional<PartitionedInverse> parts_;
  typename Pose::Point origin_;
  std::vector<std::vector<SegmentVariables>> segments_;
  std::vector<std::vector<Listed>> listed_;
  std::vector<std::vector<SegmentPlaces>> places_;
};

/// Covariances of robot a's variables, of some of its segments, with the boundaries of other robots' parts
/// and within their own, from which those with the variables of any robot listed later follow.
template <class Pose>
class CovariancesOfRobot {
 public:
  static constexpr int kDof = Pose::kDof;

  /// Of the segments [first_segment, last_segment). Computed on several threads.
  CovariancesOfRobot(std::shared_ptr<const SkeletonCovariance<Pose>> skeleton, std::size_t a,
                     std::size_t first_segment, std::size_t last_segment);

  const SkeletonCovariance<Pose>& skeleton() const { return *skeleton_; }
  std::size_t robot() const { return a_; }
  /// Cov(v, u) for the variable u of robot a's list, of sizes kRows and kColumns.
  template <int kRows, int kColumns>
  Eigen::Matrix<double, kRows, kColumns> with(const typename SkeletonCovariance<Pose>::Listed& v,
                                              std::size_t u) const;
  /// Of the segments from `first_segment` on, as many as take at most `scalars` numbers, but at least one;
  /// returns the first segment after them.
  static std::size_t segments_within(const SkeletonCovariance<Pose>& skeleton, std::size_t a,
                                     std::size_t first_segment, std::size_t scalars);

 private:
  /// Some 96 columns: enough for fast products, few enough to spread over threads.
  static constexpr std::size_t kBatch = 96 / kDof;
  struct Batch {
    std::vector<std::size_t> variables;
    std::vector<Eigen::MatrixXd>
        with_boundary;                   ///< per part: boundary x columns; empty if no later robot is in it
    std::vector<Eigen::MatrixXd> local;  ///< per variable: scalars of its part x size; empty for separators
  };
  static constexpr std::size_t kNone = ~std::size_t{0};
  struct Place {
    std::size_t batch = kNone, variable = 0;
    Eigen::Index column = 0;
  };
  using Listed = typename SkeletonCovariance<Pose>::Listed;

  void list_batches(std::size_t first_segment, std::size_t last_segment);
  static std::vector<std::size_t> parts_of_later(const SkeletonCovariance<Pose>& skeleton, std::size_t a);
  void compute(Batch& batch) const;
  Eigen::MatrixXd maps_of(const std::vector<std::size_t>& variables) const;
  void add_local(Batch& batch, const std::vector<std::size_t>& places) const;
  Eigen::Index size_of(std::size_t u) const;

  std::shared_ptr<const SkeletonCovariance<Pose>> skeleton_;
  std::size_t a_;
  std::vector<Place> places_;  ///< per variable of a
  std::vector<Batch> batches_;
  std::vector<std::size_t> parts_of_later_;  ///< with variables of robots listed later
};

/// Covariances between robot a's and robot b's segments. Thread-safe.
template <class Pose>
class CrossCovariance {
 public:
  static constexpr int kDof = Pose::kDof, kSize = 2 * kDof + 2;
  using Joint = Eigen::Matrix<double, kSize, kSize>;
  /// Which ends of a segment are wanted; the other end's covariances are left at zero.
  struct Ends {
    bool first = true, last = true;
  };

  CrossCovariance(std::shared_ptr<const CovariancesOfRobot<Pose>> of_a, std::size_t b)
      : of_a_(std::move(of_a)), b_(b) {}

  /// Cov(variables of segment t of b, variables of segment s of a).
  Joint between(std::size_t s, Ends of_s, std::size_t t, Ends of_t) const;

 private:
  std::shared_ptr<const CovariancesOfRobot<Pose>> of_a_;
  std::size_t b_;
};

}  // namespace radioslam
