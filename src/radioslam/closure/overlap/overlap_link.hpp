// Relative pose covariance in mode "link" of Wi-Closure (Wang et al., III-A): each robot's odometry is left
// unchanged, and poses k and l of two robots are related by the link c with the shortest path k -> c_a -> c_b
// -> l along the odometry (the first of equally short ones):
//   T_k_l = T_k_ca Z_c T_cb_l
//   S_kl  = Ad((Z_c T_cb_l)^-1) S_k_ca Ad(.)^T + Ad(T_cb_l^-1) S_c Ad(.)^T + S_cb_l     (right perturbations)
// In left perturbations of a's frame this is a plain sum (overlap_relative.hpp). (The paper's eq. 15 puts the
// identity on the wrong term.) Two robots without a link between them are not compared. Cost: O(1) per pair
// and link from prefix sums (odometry_prefix_sums.hpp).
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/closure/overlap/overlap_fields.hpp"
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

/// What was measured of a link: keyframe cb of robot b in keyframe ca of robot a, which is listed first.
template <class Pose>
struct LinkTransform {
  Eigen::Matrix<double, Pose::kDim, Pose::kDim> R_ca_cb;
  typename Pose::Point position_m;     ///< of cb in ca
  typename Pose::Jacobian covariance;  ///< right perturbation

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visit) {
    visit(self.R_ca_cb), visit(self.position_m), visit.symmetric(self.covariance);
  }
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
    Eigen::Matrix<double, Pose::kDim, Pose::kDim> R_a_b;
    typename Pose::Point origin_m;       ///< of b's frame in a's
    typename Pose::Jacobian covariance;  ///< of the link, left perturbation in a's frame
  };

  LinkView() = default;
  explicit LinkView(std::vector<Tie> ties) : ties_(std::move(ties)) {}

  std::size_t ties() const { return ties_.size(); }
  /// Whether a record from elsewhere can be compared.
  static bool accepts(const Record&) { return true; }
  double turn_in_a(std::size_t tie) const {
    return std::atan2(ties_[tie].R_a_b(1, 0), ties_[tie].R_a_b(0, 0));
  }
  typename Pose::Point in_a(std::size_t tie, const typename Pose::Point& p) const {
    return ties_[tie].R_a_b * p + ties_[tie].origin_m;
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

/// A keyframe at an end of a link.
template <class Pose>
struct LinkKeyframe {
  typename LinkView<Pose>::Record record;
  Eigen::Matrix<double, Pose::kDim, Pose::kDim> rotation;  ///< of its body in the robot's shifted frame

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visit) {
    LinkView<Pose>::Record::visit(self.record, visit), visit(self.rotation);
  }
};

/// One robot's keyframes in its own shifted frame.
template <class Pose>
class LinkPoses {
 public:
  using View = LinkView<Pose>;
  using Record = typename View::Record;

  /// The chain needs a covariance per step.
  explicit LinkPoses(const KeyframeOdometry<Pose>& chain);

  const std::vector<Record>& records() const { return records_; }
  const std::vector<PoseInterval>& pieces() const { return pieces_; }
  std::uint32_t component(std::size_t) const { return 0; }
  PoseSpread spread(std::size_t pose, std::size_t middle) const;
  LinkKeyframe<Pose> keyframe(std::size_t pose) const {
    return {records_[pose], poses_[pose].rotation_matrix()};
  }
  /// Covariance of T_i^-1 T_j along the odometry, right perturbation.
  typename Pose::Jacobian odometry(std::size_t i, std::size_t j) const;

 private:
  std::vector<Pose> poses_;
  std::vector<Record> records_;
  std::vector<PoseInterval> pieces_;
  PoseSpread rounding_;
};

/// The links of a team, or those of one of its robots, with the keyframes at their ends.
template <class Pose>
class LinkTeam {
 public:
  using View = LinkView<Pose>;
  /// All poses at once: nothing is kept from one pair of robots to the next.
  struct Columns {};

  LinkTeam() = default;
  /// Whether `from` sends `to` its share: the robot listed first compares.
  static bool is_shared(std::uint32_t from, std::uint32_t to) { return from > to; }
  /// Whether these can be the keyframes of a robot whose partner knows `own` of their links.
  static bool accepts(std::string_view own, std::string_view share);
  /// What robot `robot` knows of its links with later robots: by its own shares and what these sent.
  static std::optional<LinkTeam> heard(std::uint32_t robot, const OverlapShares& shares);

  void add(std::size_t a, std::size_t b, const LinkKeyframe<Pose>& of_a, const LinkKeyframe<Pose>& of_b,
           const LinkTransform<Pose>& link);

  std::vector<PoseInterval> runs(std::size_t, const LinkPoses<Pose>& poses) const {
    return {{0, poses.records().size()}};
  }
  Columns columns(std::size_t, const LinkPoses<Pose>&, const PoseInterval&) const { return {}; }
  View view(std::size_t a, std::size_t b, Columns = {}) const;

 private:
  std::map<std::pair<std::size_t, std::size_t>, std::vector<typename View::Tie>> ties_;
};

template <class P>
class LinkCovariance {
 public:
  using Pose = P;
  using Poses = LinkPoses<Pose>;
  using Team = LinkTeam<Pose>;
  using View = LinkView<Pose>;

  /// Every chain needs a covariance per step; links must refer to existing poses of two different robots.
  LinkCovariance(const std::vector<KeyframeOdometry<Pose>>& chains, std::vector<OverlapLink<Pose>> links);

  std::size_t robots() const { return robots_.size(); }
  const Poses& poses(std::size_t robot) const { return robots_[robot]; }
  const Team& team() const { return team_; }
  /// What robot `from` knows of its links with robot `to`: its keyframes at their ends, and if it is listed
  /// first the links themselves.
  std::string share(std::size_t from, std::size_t to) const;

 private:
  std::vector<Poses> robots_;
  std::vector<OverlapLink<Pose>> links_;
  Team team_;
};

}  // namespace radioslam
