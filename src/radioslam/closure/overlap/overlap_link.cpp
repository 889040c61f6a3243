#include "radioslam/closure/overlap/overlap_link.hpp"

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

template <class Pose>
using Record = typename LinkView<Pose>::Record;

template <class Pose>
void check_chain(const KeyframeOdometry<Pose>& chain) {
  const std::size_t n = chain.poses.size();
  RADIOSLAM_CHECK(chain.cov_steps.size() + 1 >= n, "every step needs a covariance");
  RADIOSLAM_CHECK(chain.travelled_m.empty() || chain.travelled_m.size() == n, "one path length per pose");
}

template <class Pose>
std::vector<Pose> shifted_poses(const KeyframeOdometry<Pose>& chain) {
  std::vector<Pose> poses;
  poses.reserve(chain.poses.size());
  const auto origin = middle_of(chain.poses);
  for (const Pose& pose : chain.poses) poses.push_back(shifted(pose, origin));
  return poses;
}

template <class Pose>
std::vector<Record<Pose>> records_of(const KeyframeOdometry<Pose>& chain, const std::vector<Pose>& poses) {
  CompensatedSum<typename Pose::Jacobian> sum;
  double travelled_m = 0;
  std::vector<Record<Pose>> records;
  records.reserve(chain.poses.size());
  for (std::size_t k = 0; k < chain.poses.size(); ++k) {
    const Pose& pose = poses[k];
    if (k > 0) {
      const auto ad = pose.adjoint();
      sum.add(congruence(ad, chain.cov_steps[k - 1]));
      travelled_m += (chain.poses[k].translation() - chain.poses[k - 1].translation()).norm();
    }
    const double path_m = chain.travelled_m.empty() ? travelled_m : chain.travelled_m[k];
    records.push_back(
        {pose.translation(), heading(pose), mirrored(sum.value()), path_m, static_cast<std::uint32_t>(k)});
  }
  return records;
}

template <class Pose>
typename Pose::Jacobian walk(const Record<Pose>& i, const Record<Pose>& j) {
  if (i.index <= j.index) return j.odometry_sum - i.odometry_sum;
  return i.odometry_sum - j.odometry_sum;
}

/// blkdiag(R, R) C blkdiag(R, R)^T.
template <class Pose>
typename Pose::Jacobian turned(const Eigen::Matrix<double, Pose::kDim, Pose::kDim>& rotation,
                               const typename Pose::Jacobian& covariance) {
  constexpr int kDim = Pose::kDim, kRotation = Pose::kDof - Pose::kDim;
  typename Pose::Jacobian turn = Pose::Jacobian::Identity();
  turn.template topLeftCorner<kDim, kDim>() = rotation;
  if constexpr (kRotation == kDim) turn.template bottomRightCorner<kRotation, kRotation>() = rotation;
  return congruence(turn, covariance);
}

/// The same link, expressed from the robot listed first.
template <class Pose>
OverlapLink<Pose> in_order(const OverlapLink<Pose>& link) {
  if (link.robot_a < link.robot_b) return link;
  const typename Pose::Jacobian ad = link.T_a_b.adjoint();
  return {link.robot_b, link.pose_b,          link.robot_a,
          link.pose_a,  link.T_a_b.inverse(), congruence(ad, link.covariance)};
}

}  // namespace

template <class Pose>
RelativePosition<Pose> LinkView<Pose>::relative(std::size_t t, const Record& k, const Record& l) const {
  const Tie& tie = ties_[t];
  const typename Pose::Point& in_b = l.position_m;
  const typename Pose::Point in_a = this->in_a(t, in_b);
  const auto at_a = motion_at<Pose>(in_a), at_b = motion_at<Pose>(in_b);
  const typename Pose::Jacobian by_a = at_a * (walk<Pose>(k, tie.a) + tie.covariance) * at_a.transpose();
  const typename Pose::Jacobian by_b = at_b * walk<Pose>(l, tie.b) * at_b.transpose();
  return {in_a - k.position_m, by_a + turned<Pose>(tie.R_a_b, by_b)};
}

template <class Pose>
LinkCovariance<Pose>::LinkCovariance(const std::vector<KeyframeOdometry<Pose>>& chains,
                                     std::vector<OverlapLink<Pose>> links)
    : links_(std::move(links)) {
  for (const auto& chain : chains) {
    check_chain(chain);
    robots_.push_back({shifted_poses(chain), {}, {}, {}});
    robots_.back().records = records_of(chain, robots_.back().poses);
    for (const auto& record : robots_.back().records)
      robots_.back().rounding.widen(
          rounding_bound<Pose>(record.odometry_sum, record.position_m, kRoundingOfSums));
    if (!chain.poses.empty()) robots_.back().pieces.push_back({0, chain.poses.size()});
  }
  for (auto& link : links_) {
    RADIOSLAM_CHECK(link.robot_a != link.robot_b, "a link connects two robots");
    RADIOSLAM_CHECK(link.robot_a < chains.size() && link.pose_a < chains[link.robot_a].poses.size() &&
                        link.robot_b < chains.size() && link.pose_b < chains[link.robot_b].poses.size(),
                    "a link refers to existing poses");
    link = in_order(link);
  }
}

template <class Pose>
PoseSpread LinkCovariance<Pose>::spread(std::size_t robot, std::size_t pose, std::size_t middle) const {
  const auto& records = robots_[robot].records;
  const typename Pose::Point& p = records[pose].position_m;
  const auto at = motion_at<Pose>(p);
  const PoseSpread by_odometry =
      spread_of<Pose>(at * walk<Pose>(records[pose], records[middle]) * at.transpose());
  const PoseSpread& rounding = robots_[robot].rounding;
  return {by_odometry.sigma_m + rounding.sigma_m, by_odometry.sigma_rad + rounding.sigma_rad};
}

template <class Pose>
typename LinkView<Pose>::Tie LinkCovariance<Pose>::tie_of(const OverlapLink<Pose>& link) const {
  const auto& a = robots_[link.robot_a].records[link.pose_a];
  const auto& b = robots_[link.robot_b].records[link.pose_b];
  const Pose T_a_cb = robots_[link.robot_a].poses[link.pose_a] * link.T_a_b;
  const Pose T_a_b = T_a_cb * robots_[link.robot_b].poses[link.pose_b].inverse();
  const typename Pose::Jacobian ad = T_a_cb.adjoint();
  return {a, b, T_a_b, T_a_b.rotation_matrix(), congruence(ad, link.covariance)};
}

template <class Pose>
LinkView<Pose> LinkCovariance<Pose>::view(std::size_t a, std::size_t b) const {
  RADIOSLAM_CHECK(a < b, "the robot listed first comes first");
  std::vector<typename View::Tie> ties;
  for (const auto& link : links_)
    if (link.robot_a == a && link.robot_b == b) ties.push_back(tie_of(link));
  return View(std::move(ties));
}

template <class Pose>
typename Pose::Jacobian LinkCovariance<Pose>::odometry(std::size_t robot, std::size_t i,
                                                       std::size_t j) const {
  const auto& records = robots_[robot].records;
  const typename Pose::Jacobian ad = robots_[robot].poses[j].inverse().adjoint();
  return ad * walk<Pose>(records[i], records[j]) * ad.transpose();
}

template class LinkView<SE2>;
template class LinkView<SE3>;
template class LinkCovariance<SE2>;
template class LinkCovariance<SE3>;

static_assert(OverlapSource<LinkCovariance<SE2>> && OverlapSource<LinkCovariance<SE3>>);

}  // namespace radioslam
