// Mode "joint": the relative pose of any two poses of a team under the joint Gaussian of a pose graph at its
// current values, the same as Marginals::relative_pose, at O(1) small products a pair.
//
// A pose k of the stretch from c1 to c2 (overlap_skeleton.hpp) is, given its ends and the drift, a bridge. In
// left perturbations (overlap_relative.hpp):
//   eta_k = (I - K_k) eta_c1 + K_k eta_c2 + D_k drift + n_k,
//   K_k = S_k S_c2^-1,   D_k = G_k - K_k G_c2,   Cov(n_k) = S_k - K_k S_k,
// n_k independent of everything outside the stretch: so Cov(eta_k, eta_l) of two robots takes the covariance
// of two stretches' ends and drifts, X_k P_st X_l^T, and P is that of the skeleton's own, much smaller graph.
//
// Columns of P are solved for when a pair of stretches is first looked at, so a search pays for the skeleton
// poses near where boxes meet only. They are kept where all fit `dense_scalars`; beyond (a range at every
// pose of long ways, say) the latest are, and the search goes through robot a's poses in runs whose columns
// are at hand. The numbers are the same either way. Robots in different components, or pieces of robots, are
// not compared: nothing ties them together. Refusals: nothing when the normal equations are singular. Cost:
// O(poses), a factorisation of the skeleton, and at most one solve per skeleton pose and pair of robots where
// all fit.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "radioslam/closure/overlap_cross_covariance.hpp"
#include "radioslam/closure/overlap_skeleton.hpp"

namespace radioslam {

template <class P>
class JointView {
 public:
  using Pose = P;
  using Jacobian = typename Pose::Jacobian;
  struct Record {
    typename Pose::Point position_m;  ///< in the common, shifted frame
    double heading_rad = 0;
    Jacobian share;                                 ///< K
    Eigen::Matrix<double, Pose::kDof, 2> by_drift;  ///< D
    Jacobian covariance;                            ///< of eta_k
    double walked_m = 0;                            ///< unused: there is one tie
    std::uint32_t stretch = 0;

    template <class Self, class Visitor>
    static void visit(Self& self, Visitor&& visit) {
      visit(self.position_m), visit(self.heading_rad), visit(self.share), visit(self.by_drift);
      visit.symmetric(self.covariance), visit(self.stretch);
    }
  };

  explicit JointView(std::shared_ptr<const CrossCovariance<Pose>> cross) : cross_(std::move(cross)) {}

  std::size_t ties() const { return 1; }
  double turn_in_a(std::size_t) const { return 0; }
  const typename Pose::Point& in_a(std::size_t, const typename Pose::Point& p) const { return p; }
  const typename Pose::Point& half_extent_in_a(std::size_t, const typename Pose::Point& half) const {
    return half;
  }
  double tie_walked_a(std::size_t) const { return 0; }
  double tie_walked_b(std::size_t) const { return 0; }
  /// Several threads can each go back and forth over as many without solving again.
  bool fits_at_hand(const Record& first, const Record& last) const {
    constexpr std::size_t kThreads = 4;
    return last.stretch - first.stretch <= cross_->stretches_at_hand() / kThreads;
  }
  RelativePlace<Pose> relative(std::size_t tie, const Record& k, const Record& l) const;

 private:
  std::shared_ptr<const CrossCovariance<Pose>> cross_;
};

template <class Pose>
class JointCovariance {
 public:
  using View = JointView<Pose>;
  using Record = typename View::Record;
  /// 512 MiB of covariances between two robots.
  static constexpr std::size_t kDenseScalars = std::size_t{1} << 26;

  /// One chain per robot, in the mission's order.
  static std::optional<JointCovariance> compute(const PoseGraph<Pose>& graph,
                                                const std::vector<ChainOfPoses>& robots,
                                                std::size_t dense_scalars = kDenseScalars);

  std::size_t robots() const { return robots_.size(); }
  const std::vector<Record>& records(std::size_t robot) const { return robots_[robot].records; }
  const std::vector<PoseInterval>& pieces(std::size_t robot) const { return robots_[robot].pieces; }
  bool joined(std::size_t a, std::size_t piece_a, std::size_t b, std::size_t piece_b) const {
    return robots_[a].components[piece_a] == robots_[b].components[piece_b];
  }
  PoseSpread spread(std::size_t robot, std::size_t pose, std::size_t middle) const;
  View view(std::size_t a, std::size_t b) const;

  /// Covariance of T_k^-1 T_l for a right perturbation, of searched poses k, l of two robots a < b.
  typename Pose::Jacobian relative_pose(std::size_t a, std::size_t k, std::size_t b, std::size_t l) const;

 private:
  using Jacobian = typename Pose::Jacobian;
  using DriftEffect = Eigen::Matrix<double, Pose::kDof, 2>;

  /// The odometry up to a searched pose since its piece began: what spreads are taken from.
  struct Walked {
    Jacobian covariance;
    DriftEffect by_drift;
  };
  struct Robot {
    std::vector<Pose> poses;  ///< searched, in the shifted frame
    std::vector<Record> records;
    std::vector<Walked> walked;
    std::vector<Eigen::Matrix2d> cov_drift;  ///< per stretch
    std::vector<PoseInterval> pieces;
    std::vector<std::int32_t> components;  ///< of the pieces
    PoseSpread rounding;
  };
  class Builder;

  std::vector<Robot> robots_;
  std::shared_ptr<const SkeletonCovariance<Pose>> skeleton_;
  std::size_t dense_scalars_ = kDenseScalars;
};

}  // namespace radioslam
