// Relative pose covariance in mode "link" of Wi-Closure (Wang et al., III-A): each robot's odometry is left
// unchanged, and poses k and l of two robots are related by the link c with the shortest path k -> c_a -> c_b
// -> l along the odometry (the first of equally short ones):
//   T_k_l = T_k_ca Z_c T_cb_l
//   S_kl  = Ad((Z_c T_cb_l)^-1) S_k_ca Ad(.)^T + Ad(T_cb_l^-1) S_c Ad(.)^T + S_cb_l     (right perturbations)
// In left perturbations of a's frame this is a plain sum (overlap_relative.hpp). (The paper's eq. 15 puts the
// identity on the wrong term.) Two robots without a link between them are not compared. Cost: O(1) per pair
// and link from prefix sums (odometry_prefix_sums.hpp).
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "radioslam/closure/overlap/overlap_relative.hpp"
#include "radioslam/geometry/compensated_sum.hpp"

namespace radioslam {

// Covariance of a robot's odometry between any two of its poses, in O(1) from prefix sums:
//   S_j = sum over k < j of Ad(T_k+1) Q_k Ad(T_k+1)^T,  Cov(eta_j - eta_i) = S_j - S_i  for i <= j
// with Q_k the covariance of the increment T_k^-1 T_k+1 (right perturbation). As a right perturbation of
// T_i^-1 T_j the covariance is Ad(T_j^-1) (S_j - S_i) Ad(T_j^-1)^T.
//
// The difference suffers cancellation: S contains (distance from the frame's origin)^2 times the yaw
// variance. The origin is therefore the mean of the poses and the sums are compensated (Neumaier), which
// leaves an error of a few units in the last place of S: 1e-8 m^2 for 10 km and 1 rad. rounding_bound()
// bounds it, and the bounds of the overlap search include it.

/// Error of a difference of prefix sums, relative to the sums.
inline constexpr double kRoundingOfSums = 64 * std::numeric_limits<double>::epsilon();

/// Bounds of the standard deviations of position, at point p, and rotation caused by this relative error of
/// `sum`.
template <class Pose>
PoseSpread rounding_bound(const typename Pose::Jacobian& sum, const typename Pose::Point& p,
                          double relative_error) {
  constexpr int kDim = Pose::kDim, kRotation = Pose::kDof - Pose::kDim;
  const double tt = sum.template topLeftCorner<kDim, kDim>().norm();
  const double tr = sum.template topRightCorner<kDim, kRotation>().norm();
  const double rr = sum.template bottomRightCorner<kRotation, kRotation>().norm();
  const double lever = p.norm();
  return {std::sqrt(relative_error * (tt + 2 * lever * tr + lever * lever * rr)),
          std::sqrt(relative_error * rr)};
}

/// One robot's keyframes in its own frame, and the covariance of the odometry between them.
template <class Pose>
struct KeyframeOdometry {
  std::vector<Pose> poses;  ///< T_start_body
  std::vector<typename Pose::Jacobian>
      cov_steps;                    ///< of T_k^-1 T_k+1, right perturbation; one fewer than poses
  std::vector<double> travelled_m;  ///< path length up to each pose; empty: summed straight distances
};

/// Relative pose T_a_b of `pose_b` of robot b in `pose_a` of robot a, with right-perturbation covariance.
template <class Pose>
struct OverlapLink {
  std::size_t robot_a = 0, pose_a = 0, robot_b = 0, pose_b = 0;
  Pose T_a_b;
  typename Pose::Jacobian covariance = Pose::Jacobian::Identity();
};

template <class P>
class LinkView {
 public:
  using Pose = P;
  struct Record {
    typename Pose::Point position_m;  ///< in the robot's shifted frame
    double heading_rad = 0;
    typename Pose::Jacobian odometry_sum;  ///< prefix sum S
    double travelled_m = 0;
    std::uint32_t index = 0;

    template <class Self, class Visitor>
    static void visit(Self& self, Visitor&& visit) {
      visit(self.position_m), visit(self.heading_rad), visit.symmetric(self.odometry_sum);
      visit(self.travelled_m), visit(self.index);
    }
  };
  /// A link with the records of both ends.
  struct Tie {
    Record a, b;
    Pose T_a_b;  ///< frame of b in frame of a
    Eigen::Matrix<double, Pose::kDim, Pose::kDim> R_a_b;
    typename Pose::Jacobian covariance;  ///< of the link, left perturbation in a's frame
  };

  LinkView() = default;
  explicit LinkView(std::vector<Tie> ties) : ties_(std::move(ties)) {}

  std::size_t ties() const { return ties_.size(); }
  double turn_in_a(std::size_t tie) const { return heading(ties_[tie].T_a_b); }
  typename Pose::Point in_a(std::size_t tie, const typename Pose::Point& p) const {
    return ties_[tie].R_a_b * p + ties_[tie].T_a_b.translation();
  }
  typename Pose::Point half_extent_in_a(std::size_t tie, const typename Pose::Point& half) const {
    return ties_[tie].R_a_b.cwiseAbs() * half;
  }
  double link_travelled_a(std::size_t tie) const { return ties_[tie].a.travelled_m; }
  double link_travelled_b(std::size_t tie) const { return ties_[tie].b.travelled_m; }
  RelativePosition<Pose> relative(std::size_t tie, const Record& k, const Record& l) const;

 private:
  std::vector<Tie> ties_;
};

template <class Pose>
class LinkCovariance {
 public:
  using View = LinkView<Pose>;

  /// Every chain needs a covariance per step; links must refer to existing poses of two different robots.
  LinkCovariance(const std::vector<KeyframeOdometry<Pose>>& chains, std::vector<OverlapLink<Pose>> links);

  std::size_t robots() const { return robots_.size(); }
  const std::vector<typename View::Record>& records(std::size_t robot) const {
    return robots_[robot].records;
  }
  const std::vector<PoseInterval>& pieces(std::size_t robot) const { return robots_[robot].pieces; }
  bool joined(std::size_t, std::size_t, std::size_t, std::size_t) const { return true; }
  PoseSpread spread(std::size_t robot, std::size_t pose, std::size_t middle) const;
  /// All poses at once: nothing is kept from one pair of robots to the next.
  struct Columns {};
  std::vector<PoseInterval> runs(std::size_t a) const { return {{0, records(a).size()}}; }
  Columns columns(std::size_t, const PoseInterval&) const { return {}; }
  View view(std::size_t a, std::size_t b, Columns) const { return view(a, b); }
  View view(std::size_t a, std::size_t b) const;

  /// Covariance of T_i^-1 T_j along one robot's odometry, right perturbation.
  typename Pose::Jacobian odometry(std::size_t robot, std::size_t i, std::size_t j) const;

 private:
  struct Robot {
    std::vector<Pose> poses;  ///< in the shifted frame
    std::vector<typename View::Record> records;
    std::vector<PoseInterval> pieces;
    PoseSpread rounding;
  };
  typename View::Tie tie_of(const OverlapLink<Pose>& link) const;

  std::vector<Robot> robots_;
  std::vector<OverlapLink<Pose>> links_;
};

}  // namespace radioslam
