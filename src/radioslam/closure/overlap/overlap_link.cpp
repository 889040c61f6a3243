#include "radioslam/closure/overlap/overlap_link.hpp"

#include <algorithm>

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

template <class Pose>
LinkTransform<Pose> transform_of(const OverlapLink<Pose>& link) {
  return {link.T_a_b.rotation_matrix(), link.T_a_b.translation(), mirrored(link.covariance)};
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
LinkPoses<Pose>::LinkPoses(const KeyframeOdometry<Pose>& chain) : poses_(shifted_poses(chain)) {
  check_chain(chain);
  records_ = records_of(chain, poses_);
  for (const Record& record : records_)
    rounding_.widen(rounding_bound<Pose>(record.odometry_sum, record.position_m, kRoundingOfSums));
  if (!chain.poses.empty()) pieces_.push_back({0, chain.poses.size()});
}

template <class Pose>
PoseSpread LinkPoses<Pose>::spread(std::size_t pose, std::size_t middle) const {
  const auto at = motion_at<Pose>(records_[pose].position_m);
  const PoseSpread by_odometry =
      spread_of<Pose>(at * walk<Pose>(records_[pose], records_[middle]) * at.transpose());
  return {by_odometry.sigma_m + rounding_.sigma_m, by_odometry.sigma_rad + rounding_.sigma_rad};
}

template <class Pose>
typename Pose::Jacobian LinkPoses<Pose>::odometry(std::size_t i, std::size_t j) const {
  const typename Pose::Jacobian ad = poses_[j].inverse().adjoint();
  return ad * walk<Pose>(records_[i], records_[j]) * ad.transpose();
}

/// T_a_b = T_a_ca T_ca_cb T_b_cb^-1, and the covariance of T_ca_cb moved to a's frame by Ad(T_a_ca T_ca_cb).
template <class Pose>
void LinkTeam<Pose>::add(std::size_t a, std::size_t b, const LinkKeyframe<Pose>& of_a,
                         const LinkKeyframe<Pose>& of_b, const LinkTransform<Pose>& link) {
  using Rotation = Eigen::Matrix<double, Pose::kDim, Pose::kDim>;
  const Rotation R_a_cb = of_a.rotation * link.R_ca_cb;
  const typename Pose::Point of_cb = of_a.rotation * link.position_m + of_a.record.position_m;
  const Rotation R_a_b = R_a_cb * of_b.rotation.transpose();
  const typename Pose::Point origin_m = of_cb - R_a_b * of_b.record.position_m;
  const auto moved = motion_at<Pose>(-of_cb);
  ties_[{a, b}].push_back(
      {of_a.record, of_b.record, R_a_b, origin_m, congruence(moved, turned<Pose>(R_a_cb, link.covariance))});
}

template <class Pose>
LinkView<Pose> LinkTeam<Pose>::view(std::size_t a, std::size_t b, Columns) const {
  RADIOSLAM_CHECK(a < b, "the robot listed first comes first");
  const auto ties = ties_.find({a, b});
  return ties == ties_.end() ? View() : View(ties->second);
}

template <class Pose>
bool LinkTeam<Pose>::accepts(std::string_view own, std::string_view share) {
  OverlapFieldReader of_own(own), in(share);
  const std::uint32_t links = in.number();
  in.refuse_unless(links == of_own.number());
  LinkKeyframe<Pose> keyframe;
  for (std::uint32_t t = 0; t < links && in.good(); ++t) LinkKeyframe<Pose>::visit(keyframe, in);
  return in.is_complete();
}

template <class Pose>
std::optional<LinkTeam<Pose>> LinkTeam<Pose>::heard(std::uint32_t robot, const OverlapShares& shares) {
  LinkTeam team;
  for (std::uint32_t b = robot + 1; b < shares.heard.size(); ++b) {
    OverlapFieldReader own(shares.own[b]), other(shares.heard[b]);
    const std::uint32_t links = std::min(own.number(), other.number());
    for (std::uint32_t t = 0; t < links; ++t) {
      LinkKeyframe<Pose> of_a, of_b;
      LinkTransform<Pose> link;
      LinkKeyframe<Pose>::visit(of_a, own);
      LinkTransform<Pose>::visit(link, own);
      LinkKeyframe<Pose>::visit(of_b, other);
      team.add(robot, b, of_a, of_b, link);
    }
    if (!own.is_complete() || !other.is_complete()) return std::nullopt;
  }
  return team;
}

template <class P>
LinkCovariance<P>::LinkCovariance(const std::vector<KeyframeOdometry<Pose>>& chains,
                                  std::vector<OverlapLink<Pose>> links)
    : links_(std::move(links)) {
  for (const auto& chain : chains) robots_.emplace_back(chain);
  for (auto& link : links_) {
    RADIOSLAM_CHECK(link.robot_a != link.robot_b, "a link connects two robots");
    RADIOSLAM_CHECK(link.robot_a < chains.size() && link.pose_a < chains[link.robot_a].poses.size() &&
                        link.robot_b < chains.size() && link.pose_b < chains[link.robot_b].poses.size(),
                    "a link refers to existing poses");
    link = in_order(link);
    team_.add(link.robot_a, link.robot_b, robots_[link.robot_a].keyframe(link.pose_a),
              robots_[link.robot_b].keyframe(link.pose_b), transform_of(link));
  }
}

template <class P>
std::string LinkCovariance<P>::share(std::size_t from, std::size_t to) const {
  OverlapFieldWriter out;
  const bool is_first = from < to;
  std::uint32_t count = 0;
  for (const auto& link : links_)
    if (link.robot_a == std::min(from, to) && link.robot_b == std::max(from, to)) {
      const LinkKeyframe<Pose> own = robots_[from].keyframe(is_first ? link.pose_a : link.pose_b);
      const LinkTransform<Pose> transform = transform_of(link);
      LinkKeyframe<Pose>::visit(own, out);
      if (is_first) LinkTransform<Pose>::visit(transform, out);
      ++count;
    }
  OverlapFieldWriter counted;
  counted(count);
  return counted.take() + out.take();
}

template class LinkView<SE2>;
template class LinkView<SE3>;
template class LinkPoses<SE2>;
template class LinkPoses<SE3>;
template class LinkTeam<SE2>;
template class LinkTeam<SE3>;
template class LinkCovariance<SE2>;
template class LinkCovariance<SE3>;

static_assert(OverlapSource<LinkCovariance<SE2>> && OverlapSource<LinkCovariance<SE3>>);

}  // namespace radioslam
