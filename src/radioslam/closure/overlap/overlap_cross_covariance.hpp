// Covariances of skeleton poses and drifts, within a segment and between the segments of two robots (left
// perturbations eta = Ad(T) xi in a shifted frame; see overlap_joint.hpp).
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
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

/// A variable of a robot's segments.
template <class Pose>
struct SkeletonVariable {
  std::int32_t block = -1;                                       ///< of the information matrix; -1: held
  bool is_pose = true;                                           ///< else a drift
  typename Pose::Jacobian to_left = Pose::Jacobian::Identity();  ///< from right perturbations; of a pose

  Eigen::Index size() const { return is_pose ? Pose::kDof : 2; }
};

/// A robot's segments and their variables, each once.
template <class Pose>
struct SkeletonSegments {
  std::vector<SkeletonVariable<Pose>> variables;
  std::vector<SegmentPlaces> places;
};

/// Information on the skeleton's variables at the joint estimate, right perturbations: what all robots of a
/// team must know to compare their poses.
template <class Pose>
struct SkeletonInformation {
  SymmetricBlockMatrix matrix;
  std::vector<std::int32_t> last;  ///< blocks that touch many others: drifts and biases
  std::vector<SkeletonSegments<Pose>> robots;
};

/// Of the reduced graph at its values. Frames are shifted by `origin`.
template <class Pose>
SkeletonInformation<Pose> information_of(const PoseGraph<Pose>& reduced, const typename Pose::Point& origin,
                                         const std::vector<std::vector<SegmentVariables>>& segments);

/// Inverse of the information matrix. Thread-safe.
template <class Pose>
class SkeletonCovariance {
 public:
  static constexpr int kDof = Pose::kDof, kSize = 2 * kDof + 2;  ///< dimension of a segment's variables
  using Joint = Eigen::Matrix<double, kSize, kSize>;

  /// A variable, and where its covariances are.
  struct Listed : SkeletonVariable<Pose> {
    std::size_t part = 0;
    const double* by_boundary = nullptr;  ///< boundary of its part x size
    Eigen::Index boundary = 0, local_column = 0;
    bool is_free = false, is_separator = false;
  };

  /// Nothing if some variable is unobservable, or the factor would have more than `max_scalars` numbers.
  static std::shared_ptr<SkeletonCovariance> compute(
      SkeletonInformation<Pose> information,
      std::size_t max_scalars = std::numeric_limits<std::size_t>::max());

  const SkeletonInformation<Pose>& information() const { return information_; }
  std::size_t robots() const { return listed_.size(); }
  std::size_t segments(std::size_t robot) const { return information_.robots[robot].places.size(); }
  /// A robot's variables, each once.
  const std::vector<Listed>& listed(std::size_t robot) const { return listed_[robot]; }
  /// Those of a segment, as indices into the list.
  const SegmentPlaces& places(std::size_t robot, std::size_t segment) const {
    return information_.robots[robot].places[segment];
  }
  /// Nothing if no variable is free.
  std::optional<SelectedInverse> selected_inverse() const;
  /// Nothing if no variable is free.
  const std::optional<PartitionedInverse>& parts() const { return parts_; }

 private:
  explicit SkeletonCovariance(SkeletonInformation<Pose> information) : information_(std::move(information)) {}

  void list_variables();

  SkeletonInformation<Pose> information_;
  std::optional<BlockCholesky> cholesky_;
  std::optional<PartitionedInverse> parts_;
  std::vector<std::vector<Listed>> listed_;
};

/// Covariances of each segment's own variables.
template <class Pose>
class SegmentCovariances {
 public:
  using Joint = typename SkeletonCovariance<Pose>::Joint;

  /// Refers to the skeleton.
  explicit SegmentCovariances(const SkeletonCovariance<Pose>& skeleton)
      : skeleton_(skeleton), inverse_(skeleton.selected_inverse()) {}

  Joint within(std::size_t robot, std::size_t segment) const;

 private:
  using Listed = typename SkeletonCovariance<Pose>::Listed;
  Eigen::MatrixXd block(const Listed& a, const Listed& b) const;

  const SkeletonCovariance<Pose>& skeleton_;
  std::optional<SelectedInverse> inverse_;
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
  Eigen::Index size_of(std::size_t u) const { return skeleton_->listed(a_)[u].size(); }

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

  /// Number of segments of b.
  std::size_t segments() const { return of_a_->skeleton().segments(b_); }
  /// Cov(variables of segment t of b, variables of segment s of a).
  Joint between(std::size_t s, Ends of_s, std::size_t t, Ends of_t) const;

 private:
  std::shared_ptr<const CovariancesOfRobot<Pose>> of_a_;
  std::size_t b_;
};

}  // namespace radioslam
