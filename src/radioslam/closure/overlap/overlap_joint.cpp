#include "radioslam/closure/overlap/overlap_joint.hpp"

#include <algorithm>
#include <string_view>

#include "radioslam/base/check.hpp"
#include "radioslam/closure/overlap/overlap_link.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

/// Upper bound of the relative error of the skeleton's covariances, from factorisation and solve; about 1e-12
/// in practice.
constexpr double kSolveError = 1e-11;
/// A factor with more numbers than these many a byte of the matrix, and this many besides, is not that of a
/// team's trajectories.
constexpr std::size_t kFill = 8, kFreeScalars = 1'000'000;

}  // namespace

template <class Pose>
RelativePosition<Pose> JointView<Pose>::relative(std::size_t, const Record& k, const Record& l) const {
  constexpr int kDof = Pose::kDof, kSize = 2 * kDof + 2;
  const auto ends = [](const Jacobian& share) {
    return typename CrossCovariance<Pose>::Ends{!share.isIdentity(0), !share.isZero(0)};
  };
  const auto joint = cross_->between(k.segment, ends(k.share), l.segment, ends(l.share));
  // X_l P, then P X_k^T: X = [I - K, K, D].
  const auto first = joint.template topRows<kDof>();
  const Eigen::Matrix<double, kDof, kSize> of_l =
      first + l.share.lazyProduct(joint.template middleRows<kDof>(kDof) - first) +
      l.by_drift.lazyProduct(joint.template bottomRows<2>());
  const auto of_first = of_l.template leftCols<kDof>();
  const Jacobian cross = of_first +
                         (of_l.template middleCols<kDof>(kDof) - of_first).lazyProduct(k.share.transpose()) +
                         of_l.template rightCols<2>().lazyProduct(k.by_drift.transpose());
  const Jacobian between = l.covariance + k.covariance - cross - cross.transpose();
  const auto at_l = motion_at<Pose>(l.position_m);
  return {l.position_m - k.position_m, at_l * between * at_l.transpose()};
}

/// Makes the robots' poses of a joint estimate, from its skeleton.
template <class Pose>
class JointPosesBuilder {
 public:
  using Robot = JointPoses<Pose>;
  using Record = typename Robot::Record;
  using Jacobian = typename Pose::Jacobian;
  using DriftEffect = Eigen::Matrix<double, Pose::kDof, 2>;

  JointPosesBuilder(const PoseGraph<Pose>& graph, const std::vector<ChainOfPoses>& robots)
      : graph_(graph),
        chains_(robots),
        skeleton_(reduce_to_skeleton(graph, robots)),
        origin_(middle_of(graph.poses)) {}

  std::shared_ptr<SkeletonCovariance<Pose>> covariance() const {
    std::vector<std::vector<SegmentVariables>> segments(chains_.size());
    for (std::size_t c = 0; c < chains_.size(); ++c)
      for (const ChainSegment& s : skeleton_.chains[c].segments)
        segments[c].push_back({reduced(c, s.first), reduced(c, s.last), s.drift});
    return SkeletonCovariance<Pose>::compute(information_of(skeleton_.graph, origin_, segments));
  }

  Robot robot(std::size_t c, const SegmentCovariances<Pose>& covariance) const {
    Robot robot;
    const auto& chain = skeleton_.chains[c];
    std::vector<bool> searched(chains_[c].poses.size(), chains_[c].searched.empty());
    for (const std::size_t k : chains_[c].searched) searched[k] = true;
    IntervalSums sums;
    for (std::size_t s = 0; s < chain.segments.size(); ++s) {
      const ChainSegment& segment = chain.segments[s];
      const auto joint = covariance.within(c, s);
      robot.cov_drift_.push_back(joint.template bottomRightCorner<2, 2>());
      if (starts_interval(chain, s)) {
        sums = {};
        close_interval(robot);
        robot.components_.push_back(
            static_cast<std::uint32_t>(skeleton_.component[chains_[c].poses[segment.first].index()]));
      }
      add_segment(c, s, joint, searched, sums, robot);
    }
    close_interval(robot);
    drop_empty_intervals(robot);
    for (std::size_t k = 0; k < robot.records_.size(); ++k) robot.rounding_.widen(rounding(robot, k));
    return robot;
  }

 private:
  /// Odometry sums since the beginning of an interval, in the common frame.
  struct IntervalSums {
    CompensatedSum<Jacobian> covariance;
    CompensatedSum<DriftEffect> by_drift;
  };

  PoseId reduced(std::size_t c, std::size_t k) const {
    return skeleton_.of_pose[chains_[c].poses[k].index()];
  }
  const Pose& pose(std::size_t c, std::size_t k) const { return graph_.poses[chains_[c].poses[k].index()]; }

  static bool starts_interval(const SkeletonChain<Pose>& chain, std::size_t s) {
    if (s == 0) return true;
    const ChainSegment &last = chain.segments[s - 1], &segment = chain.segments[s];
    return last.last != segment.first || last.drift != segment.drift;
  }

  static void close_interval(Robot& robot) {
    const std::size_t begin = robot.pieces_.empty() ? 0 : robot.pieces_.back().end;
    if (!robot.components_.empty()) robot.pieces_.push_back({begin, robot.records_.size()});
  }
  static void drop_empty_intervals(Robot& robot) {
    for (std::size_t p = robot.pieces_.size(); p-- > 0;) {
      if (robot.pieces_[p].size() > 0) continue;
      robot.pieces_.erase(robot.pieces_.begin() + static_cast<std::ptrdiff_t>(p));
      robot.components_.erase(robot.components_.begin() + static_cast<std::ptrdiff_t>(p));
    }
  }

  /// Adds records of a segment's poses; its last one belongs to the segment that begins there, if any.
  void add_segment(std::size_t c, std::size_t s, const typename SkeletonCovariance<Pose>::Joint& joint,
                   const std::vector<bool>& searched, IntervalSums& sums, Robot& robot) const {
    const auto& chain = skeleton_.chains[c];
    const ChainSegment& segment = chain.segments[s];
    const Pose T_c1 = shifted(pose(c, segment.first), origin_);
    const bool next_begins = s + 1 < chain.segments.size() && chain.segments[s + 1].first == segment.last;
    const SegmentSums<Pose> whole = sum_of(c, segment);
    const Cholesky<Jacobian> whole_cholesky(whole.covariance());
    SegmentSums<Pose> here;
    for (std::size_t k = segment.first; k <= segment.last; ++k) {
      if (k > segment.first) step(c, k, segment, here, sums);
      if (!searched[k] || (k == segment.last && next_begins)) continue;
      Jacobian share = Jacobian::Zero();
      if (k > segment.first) share = whole_cholesky.solve_matrix(here.covariance()).transpose();
      if (k > segment.first && k == segment.last) share.setIdentity();
      robot.poses_.push_back(shifted(pose(c, k), origin_));
      robot.records_.push_back(record(robot.poses_.back(), T_c1, share, here, whole, joint));
      robot.records_.back().segment = static_cast<std::uint32_t>(s);
      robot.odometry_sums_.push_back({sums.covariance.value(), sums.by_drift.value()});
    }
  }

  SegmentSums<Pose> sum_of(std::size_t c, const ChainSegment& segment) const {
    SegmentSums<Pose> sums;
    const Pose T_c1_w = pose(c, segment.first).inverse();
    for (std::size_t k = segment.first; k < segment.last; ++k)
      sums.add(*skeleton_.chains[c].steps[k], T_c1_w * pose(c, k + 1));
    return sums;
  }

  void step(std::size_t c, std::size_t k, const ChainSegment& segment, SegmentSums<Pose>& here,
            IntervalSums& sums) const {
    const auto& step = *skeleton_.chains[c].steps[k - 1];
    here.add(step, pose(c, segment.first).inverse() * pose(c, k));
    const Jacobian ad = shifted(pose(c, k), origin_).adjoint();
    sums.covariance.add(congruence(ad, step.covariance));
    sums.by_drift.add(ad * step.drift_effect);
  }

  static Record record(const Pose& T_k, const Pose& T_c1, const Jacobian& share,
                       const SegmentSums<Pose>& here, const SegmentSums<Pose>& whole,
                       const typename SkeletonCovariance<Pose>::Joint& joint) {
    constexpr int kDof = Pose::kDof;
    const Jacobian ad = T_c1.adjoint(), back = T_c1.inverse().adjoint();
    const Jacobian noise = here.covariance() - share * here.covariance();
    Record record{T_k.translation(),
                  heading(T_k),
                  ad * share * back,
                  ad * (here.drift_effect() - share * whole.drift_effect()),
                  {},
                  0,
                  0};
    Eigen::Matrix<double, kDof, 2 * kDof + 2> x;
    x << Jacobian::Identity() - record.share, record.share, record.by_drift;
    record.covariance = mirrored<Jacobian>(x * joint * x.transpose() + ad * noise * ad.transpose());
    return record;
  }

  static PoseSpread rounding(const Robot& robot, std::size_t k) {
    const typename Pose::Point& p = robot.records_[k].position_m;
    const PoseSpread sums = rounding_bound<Pose>(robot.odometry_sums_[k].covariance, p, kRoundingOfSums);
    const PoseSpread solved = rounding_bound<Pose>(robot.records_[k].covariance, p, kSolveError);
    return {sums.sigma_m + solved.sigma_m, sums.sigma_rad + solved.sigma_rad};
  }

  const PoseGraph<Pose>& graph_;
  const std::vector<ChainOfPoses>& chains_;
  Skeleton<Pose> skeleton_;
  typename Pose::Point origin_;
};

template <class Pose>
std::optional<JointCovariance<Pose>> JointCovariance<Pose>::compute(const PoseGraph<Pose>& graph,
                                                                    const std::vector<ChainOfPoses>& robots,
                                                                    std::size_t dense_scalars) {
  const JointPosesBuilder<Pose> builder(graph, robots);
  const auto skeleton = builder.covariance();
  if (!skeleton) return std::nullopt;
  const SegmentCovariances<Pose> within(*skeleton);
  std::vector<Poses> poses;
  for (std::size_t c = 0; c < robots.size(); ++c) poses.push_back(builder.robot(c, within));
  return JointCovariance(std::move(poses), Team(skeleton, dense_scalars));
}

/// Conditioning on measurements never increases a covariance: sigma(eta_k - eta_m) is at most that of the
/// odometry noise alone plus that of the estimated drift.
template <class Pose>
PoseSpread JointPoses<Pose>::spread(std::size_t pose, std::size_t middle) const {
  using Jacobian = typename Pose::Jacobian;
  const Record& record = records_[pose];
  const auto [first, last] = std::minmax(pose, middle);
  const Jacobian at = motion_at<Pose>(record.position_m);
  const auto &begin = odometry_sums_[first], &end = odometry_sums_[last];
  const Jacobian noise = at * (end.covariance - begin.covariance) * at.transpose();
  const Eigen::Matrix<double, Pose::kDof, 2> by_drift = at * (end.by_drift - begin.by_drift);
  const Jacobian drift = by_drift * cov_drift_[record.segment] * by_drift.transpose();
  const PoseSpread a = spread_of<Pose>(noise), b = spread_of<Pose>(drift);
  return {a.sigma_m + b.sigma_m + rounding_.sigma_m, a.sigma_rad + b.sigma_rad + rounding_.sigma_rad};
}

template <class Pose>
std::optional<JointTeam<Pose>> JointTeam<Pose>::heard(std::uint32_t robot, const OverlapShares& shares) {
  std::vector<std::string_view> rows(shares.heard.begin(), shares.heard.end());
  rows[robot] = shares.own[robot == 0 ? rows.size() - 1 : 0];
  std::size_t bytes = 0;
  for (const std::string_view of_robot : rows) bytes += of_robot.size();
  auto information = read_rows<Pose>(rows);
  if (!information) return std::nullopt;
  auto skeleton = SkeletonCovariance<Pose>::compute(*std::move(information), kFreeScalars + kFill * bytes);
  if (!skeleton) return std::nullopt;
  return JointTeam(std::move(skeleton));
}

template <class Pose>
std::vector<PoseInterval> JointTeam<Pose>::runs(std::size_t a, const JointPoses<Pose>& poses) const {
  std::vector<PoseInterval> runs;
  const std::vector<Record>& records = poses.records();
  for (std::size_t begin = 0; begin < records.size();) {
    const std::size_t last =
        CovariancesOfRobot<Pose>::segments_within(*skeleton_, a, records[begin].segment, dense_scalars_);
    std::size_t end = begin;
    while (end < records.size() && records[end].segment < last) ++end;
    runs.push_back({begin, end});
    begin = end;
  }
  return runs;
}

template <class Pose>
typename JointTeam<Pose>::Columns JointTeam<Pose>::columns(std::size_t a, const JointPoses<Pose>& poses,
                                                           const PoseInterval& run) const {
  const std::vector<Record>& records = poses.records();
  std::size_t first = 0, last = 0;
  if (run.size() > 0) {
    first = records[run.begin].segment;
    last = records[run.end - 1].segment + std::size_t{1};
  }
  return std::make_shared<const CovariancesOfRobot<Pose>>(skeleton_, a, first, last);
}

template <class Pose>
JointView<Pose> JointTeam<Pose>::view(std::size_t a, std::size_t b, const Columns& columns_of_a) const {
  RADIOSLAM_CHECK(a < b, "the robot listed first comes first");
  return View(std::make_shared<CrossCovariance<Pose>>(columns_of_a, b));
}

template <class Pose>
typename Pose::Jacobian JointCovariance<Pose>::relative_pose(std::size_t a, std::size_t k, std::size_t b,
                                                             std::size_t l) const {
  const View view = team_.view(a, b, team_.columns(a, robots_[a], {k, k + 1}));
  const RelativePosition<Pose> place = view.relative(0, robots_[a].records()[k], robots_[b].records()[l]);
  // Right perturbation at l: rotate both parts into l's axes.
  const Pose turn = Pose(Pose::Point::Zero(), rotation_of(robots_[b].poses_[l]));
  const typename Pose::Jacobian back = turn.inverse().adjoint();
  return congruence(back, place.covariance);
}

template class JointView<SE2>;
template class JointView<SE3>;
template class JointPoses<SE2>;
template class JointPoses<SE3>;
template class JointTeam<SE2>;
template class JointTeam<SE3>;
template class JointCovariance<SE2>;
template class JointCovariance<SE3>;

static_assert(OverlapSource<JointCovariance<SE2>> && OverlapSource<JointCovariance<SE3>>);

}  // namespace radioslam
