// Relative pose covariance in mode "joint": between any two poses of a team, under the joint Gaussian of a
// pose graph at its current values. Equal to Marginals::relative_pose, with a product of two
// small matrices per pair.
//
// Given its ends c1, c2 and the drift, pose k of a segment (keyframe_skeleton.hpp) is conditionally
// independent of everything outside. In left perturbations (overlap_relative.hpp):
//   eta_k = (I - K_k) eta_c1 + K_k eta_c2 + D_k drift + n_k,
//   K_k = S_k S_c2^-1,   D_k = G_k - K_k G_c2,   Cov(n_k) = S_k - K_k S_k,
// so Cov(eta_k, eta_l) = X_k P_st X_l^T for poses of two robots, with P the covariance of the ends and drifts
// of two segments, from the much smaller skeleton graph.
//
// P comes from a partition of the skeleton's elimination tree (graph/linear/partitioned_inverse.hpp). What it
// takes of robot a is computed once for all later robots. A search visits a's poses in runs for which that
// fits into `dense_scalars`, all other robots within a run. Results are the same for any runs, up to
// rounding. Trajectories of different graph components are not compared. Returns nothing if the normal
// equations are singular. Cost: O(poses), one factorisation of the skeleton, and per pair of poses the
// product of two maps onto the boundaries of their parts.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/closure/overlap/keyframe_skeleton.hpp"
#include "radioslam/closure/overlap/overlap_cross_covariance.hpp"
#include "radioslam/closure/overlap/overlap_fields.hpp"
#include "radioslam/closure/overlap/overlap_relative.hpp"
#include "radioslam/closure/overlap/skeleton_message.hpp"

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
    double travelled_m = 0;                         ///< unused: there is no choice of links
    std::uint32_t segment = 0;

    template <class Self, class Visitor>
    static void visit(Self& self, Visitor&& visit) {
      visit(self.position_m), visit(self.heading_rad), visit(self.share), visit(self.by_drift);
      visit.symmetric(self.covariance), visit(self.segment);
    }
  };

  explicit JointView(std::shared_ptr<const CrossCovariance<Pose>> cross) : cross_(std::move(cross)) {}

  std::size_t ties() const { return 1; }
  /// Whether a record from elsewhere can be compared.
  bool accepts(const Record& l) const { return l.segment < cross_->segments(); }
  double turn_in_a(std::size_t) const { return 0; }
  const typename Pose::Point& in_a(std::size_t, const typename Pose::Point& p) const { return p; }
  const typename Pose::Point& half_extent_in_a(std::size_t, const typename Pose::Point& half) const {
    return half;
  }
  double link_travelled_a(std::size_t) const { return 0; }
  double link_travelled_b(std::size_t) const { return 0; }
  RelativePosition<Pose> relative(std::size_t tie, const Record& k, const Record& l) const;

 private:
  std::shared_ptr<const CrossCovariance<Pose>> cross_;
};

/// Odometry sums up to a searched pose, from which spreads are computed.
template <class Pose>
struct JointOdometrySums {
  typename Pose::Jacobian covariance;
  Eigen::Matrix<double, Pose::kDof, 2> by_drift;
};

/// One robot's searched poses, in the common, shifted frame.
template <class P>
class JointPoses {
 public:
  using Pose = P;
  using View = JointView<Pose>;
  using Record = typename View::Record;

  const std::vector<Record>& records() const { return records_; }
  const std::vector<PoseInterval>& pieces() const { return pieces_; }
  std::uint32_t component(std::size_t piece) const { return components_[piece]; }
  PoseSpread spread(std::size_t pose, std::size_t middle) const;

 private:
  template <class>
  friend class JointPosesBuilder;
  template <class>
  friend class JointCovariance;

  std::vector<Pose> poses_;
  std::vector<Record> records_;
  std::vector<JointOdometrySums<Pose>> odometry_sums_;
  std::vector<Eigen::Matrix2d> cov_drift_;  ///< per segment
  std::vector<PoseInterval> pieces_;
  std::vector<std::uint32_t> components_;  ///< graph component per interval
  PoseSpread rounding_;
};

/// What all robots know of the joint estimate: the skeleton's covariances.
template <class Pose>
class JointTeam {
 public:
  using View = JointView<Pose>;
  using Record = typename View::Record;
  using Columns = std::shared_ptr<const CovariancesOfRobot<Pose>>;
  /// Of a run: at most 256 MiB of covariances.
  static constexpr std::size_t kDenseScalars = std::size_t{1} << 25;

  explicit JointTeam(std::shared_ptr<const SkeletonCovariance<Pose>> skeleton,
                     std::size_t dense_scalars = kDenseScalars)
      : skeleton_(std::move(skeleton)), dense_scalars_(dense_scalars) {}

  /// Runs of robot a's poses, as long as what is kept of them fits into `dense_scalars`.
  std::vector<PoseInterval> runs(std::size_t a, const JointPoses<Pose>& poses) const;
  /// What the covariances of a run of robot a's poses with any other robot take.
  Columns columns(std::size_t a, const JointPoses<Pose>& poses, const PoseInterval& run) const;
  View view(std::size_t a, std::size_t b, const Columns& columns_of_a) const;

  /// Whether `from` sends `to` its share.
  static bool is_shared(std::uint32_t, std::uint32_t) { return true; }
  /// Whether these can be a robot's share.
  static bool accepts(std::string_view, std::string_view share) { return is_rows<Pose>(share); }
  /// The same from what the robots sent each other. Nothing unless it is one team's estimate.
  static std::optional<JointTeam> heard(std::uint32_t robot, const OverlapShares& shares);
  std::string share(std::size_t robot) const { return write_rows(skeleton_->information(), robot); }

 private:
  std::shared_ptr<const SkeletonCovariance<Pose>> skeleton_;
  std::size_t dense_scalars_;
};

template <class P>
class JointCovariance {
 public:
  using Pose = P;
  using Poses = JointPoses<Pose>;
  using Team = JointTeam<Pose>;
  using View = JointView<Pose>;

  /// One chain per robot, in the order of the mission.
  static std::optional<JointCovariance> compute(const PoseGraph<Pose>& graph,
                                                const std::vector<ChainOfPoses>& robots,
                                                std::size_t dense_scalars = Team::kDenseScalars);

  std::size_t robots() const { return robots_.size(); }
  const Poses& poses(std::size_t robot) const { return robots_[robot]; }
  const Team& team() const { return team_; }
  /// What robot `from` sends every other before a search: its rows of the skeleton's information matrix.
  std::string share(std::size_t from, std::size_t) const { return team_.share(from); }

  /// Covariance of T_k^-1 T_l (right perturbation) between searched poses k, l of robots a < b.
  typename Pose::Jacobian relative_pose(std::size_t a, std::size_t k, std::size_t b, std::size_t l) const;

 private:
  JointCovariance(std::vector<Poses> robots, Team team)
      : robots_(std::move(robots)), team_(std::move(team)) {}

  std::vector<Poses> robots_;
  Team team_;
};

}  // namespace radioslam
