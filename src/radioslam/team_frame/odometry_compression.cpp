#include "radioslam/team_frame/odometry_compression.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/pose_ids.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

/// However many robots there are, a pair keeps so many links.
constexpr std::size_t kLeastLinks = 8;

/// Keeps at most so many measurements of a kind between two segments or a segment and a point, evenly spread.
template <class Pose>
class Thinning {
 public:
  explicit Thinning(const TeamGraph<Pose>& team)
      : segment_of_(segment_of_poses(team)), partners_(team.segments.size()) {
    for (const auto& range : team.graph.ranges) connect(number(range.i), number(range.j));
    for (const auto& bearing : team.bearings) connect(number(bearing.i), number(bearing.j));
  }

  template <class Factor>
  std::vector<Factor> operator()(const std::vector<Factor>& factors, std::size_t most) const {
    return kept(factors, [&](const Ends&) { return most; });
  }
  /// The same, and of measurements between segments at most about `most_of_segment` per segment.
  template <class Factor>
  std::vector<Factor> operator()(const std::vector<Factor>& factors, std::size_t most,
                                 std::size_t most_of_segment) const {
    return kept(factors, [&](const Ends& ends) {
      if (ends.first < 0 || ends.second < 0) return most;  // a point
      const std::size_t pairs = std::max(partners(ends.first), partners(ends.second));
      return std::min(most, std::max(kLeastLinks, most_of_segment / pairs));
    });
  }

 private:
  using Ends = std::pair<std::int64_t, std::int64_t>;
  template <class Factor, class Most>
  std::vector<Factor> kept(const std::vector<Factor>& factors, const Most& most_between) const {
    std::map<Ends, std::size_t> total, seen;
    for (const Factor& f : factors) ++total[ends(f)];
    std::vector<Factor> kept;
    for (const Factor& f : factors) {
      const std::size_t n = total[ends(f)], k = seen[ends(f)]++, most = most_between(ends(f));
      if (n <= most || (k + 1) * most / n != k * most / n) kept.push_back(f);
    }
    return kept;
  }
  std::int64_t number(const auto& end) const { return end_number(segment_of_, end); }
  Ends ends(const auto& factor) const { return std::minmax(number(factor.i), number(factor.j)); }
  /// Angles are thinned by receiver, so that those of the exchanges stay whose ranges do.
  Ends ends(const AmbiguousBearing<Pose>& bearing) const { return {number(bearing.i), number(bearing.j)}; }

  void connect(std::int64_t a, std::int64_t b) {
    if (a < 0 || b < 0) return;
    partners_[static_cast<std::size_t>(a)].insert(b);
    partners_[static_cast<std::size_t>(b)].insert(a);
  }
  std::size_t partners(std::int64_t segment) const {
    return partners_[static_cast<std::size_t>(segment)].size();
  }

  std::vector<std::size_t> segment_of_;
  std::vector<std::set<std::int64_t>> partners_;  ///< segments with a measurement to each
};

}  // namespace

template <class Pose>
TeamGraph<Pose> thin_links(const TeamGraph<Pose>& team, const GridParams& params) {
  const auto max_links = static_cast<std::size_t>(params.max_links);
  const auto of_segment = static_cast<std::size_t>(params.max_links_of_robot);
  const auto max_sightings = static_cast<std::size_t>(params.max_sightings);
  const Thinning<Pose> thin(team);
  TeamGraph<Pose> fewer = team;
  fewer.graph.ranges = thin(team.graph.ranges, max_links, of_segment);
  fewer.bearings = thin(team.bearings, max_links, of_segment);
  fewer.graph.relative_points = thin(team.graph.relative_points, max_sightings);
  return fewer;
}

template TeamGraph<SE2> thin_links(const TeamGraph<SE2>&, const GridParams&);
template TeamGraph<SE3> thin_links(const TeamGraph<SE3>&, const GridParams&);

namespace {

template <class Pose>
std::vector<bool> kept_poses(const TeamGraph<Pose>& team, const std::vector<std::int32_t>& into) {
  std::vector<bool> kept(team.graph.poses.size(), false);
  const auto keep = [&](PoseId id) {
    if (id.valid()) kept[id.index()] = true;
  };
  for (const TrajectorySegment& segment : team.segments) kept[segment.first_pose] = true;
  for (std::size_t k = 0; k < team.graph.relative_poses.size(); ++k) {
    const auto& factor = team.graph.relative_poses[k];
    if (into[factor.j.index()] == static_cast<std::int32_t>(k)) continue;
    keep(factor.i);
    keep(factor.j);
  }
  for (const auto& f : team.graph.ranges) keep(f.i.pose), keep(f.j.pose);
  for (const auto& f : team.bearings) keep(f.i), keep(f.j.pose);
  for (const auto& f : team.graph.relative_points) keep(f.i), keep(f.j.pose);
  for (const auto& f : team.graph.positions) keep(f.i.pose);
  for (const auto& f : team.graph.pose_priors) keep(f.i);
  return kept;
}

/// Composes consecutive odometry factors.
template <class Pose>
class Composition {
 public:
  bool empty() const { return empty_; }
  void append(const RelativePoseFactor<Pose>& factor) {
    if (empty_) sum_ = RelativePoseFactor<Pose>{factor.i, factor.j, Pose(), {}, {}, 1, factor.drift};
    if (empty_) covariance_.setZero();
    empty_ = false;
    const typename Pose::Jacobian carry = factor.T_i_j.inverse().adjoint();
    covariance_ = congruence(carry, covariance_, inverse(factor.information));
    sum_.drift_jacobian = (carry * sum_.drift_jacobian + factor.drift_jacobian).eval();
    sum_.T_i_j = sum_.T_i_j * factor.T_i_j;
  }
  /// The composition so far as a factor between compressed poses i and j; starts a new one.
  RelativePoseFactor<Pose> take(PoseId i, PoseId j) {
    sum_.i = i;
    sum_.j = j;
    sum_.information = inverse(covariance_);
    empty_ = true;
    return sum_;
  }

 private:
  bool empty_ = true;
  RelativePoseFactor<Pose> sum_;
  typename Pose::Jacobian covariance_ = Pose::Jacobian::Zero();
};

/// Copies the factors except relative poses, with the poses' new ids.
template <class Pose>
void copy_other_factors(const TeamGraph<Pose>& full, const std::vector<PoseId>& new_id,
                        TeamGraph<Pose>& team) {
  PoseGraph<Pose>& graph = team.graph;
  graph.ranges = full.graph.ranges;
  team.bearings = full.bearings;
  graph.relative_points = full.graph.relative_points;
  graph.positions = full.graph.positions;
  graph.pose_priors = full.graph.pose_priors;
  graph.drift_priors = full.graph.drift_priors;
  const auto renumber = [&](PoseId& id) { id = new_id[id.index()]; };
  for_each_pose_id(graph.ranges, renumber);
  for_each_pose_id(team.bearings, renumber);
  for_each_pose_id(graph.relative_points, renumber);
  for_each_pose_id(graph.positions, renumber);
  for_each_pose_id(graph.pose_priors, renumber);
}

template <class Pose>
TrajectorySegment compress_segment(const TeamGraph<Pose>& full, const TrajectorySegment& segment,
                                   const std::vector<std::int32_t>& into, const std::vector<bool>& kept,
                                   CompressedTeam<Pose>& result, std::vector<PoseId>& new_id) {
  TrajectorySegment shorter{segment.robot,          result.full_pose.size(), 0, {}, segment.sigma_heading_rad,
                            segment.in_common_frame};
  Composition<Pose> composition;
  for (std::size_t n = 0; n < segment.pose_count; ++n) {
    const std::size_t k = segment.first_pose + n;
    if (n > 0) {
      RADIOSLAM_CHECK(into[k] != kNoOdometry, "consecutive poses of a segment need odometry");
      composition.append(full.graph.relative_poses[static_cast<std::size_t>(into[k])]);
    }
    if (!kept[k]) continue;
    const PoseId id(result.full_pose.size());
    if (n > 0) result.team.graph.relative_poses.push_back(composition.take(PoseId(id.value - 1), id));
    new_id[k] = id;
    result.full_pose.push_back(PoseId(k));
    result.team.graph.poses.push_back(full.graph.poses[k]);
    shorter.stamps.push_back(segment.stamps[n]);
    ++shorter.pose_count;
  }
  return shorter;
}

}  // namespace

template <class Pose>
std::vector<std::int32_t> odometry_into(const TeamGraph<Pose>& team) {
  std::vector<std::int32_t> segment_of(team.graph.poses.size(), kNoOdometry);
  for (std::size_t p = 0; p < team.segments.size(); ++p)
    std::fill_n(segment_of.begin() + static_cast<std::ptrdiff_t>(team.segments[p].first_pose),
                team.segments[p].pose_count, static_cast<std::int32_t>(p));
  std::vector<std::int32_t> into(team.graph.poses.size(), kNoOdometry);
  for (std::size_t k = 0; k < team.graph.relative_poses.size(); ++k) {
    const auto& factor = team.graph.relative_poses[k];
    const std::size_t i = factor.i.index(), j = factor.j.index();
    if (j == i + 1 && segment_of[i] == segment_of[j] && into[j] == kNoOdometry)
      into[j] = static_cast<std::int32_t>(k);
  }
  return into;
}

template <class Pose>
CompressedTeam<Pose> compress(const TeamGraph<Pose>& full) {
  const auto into = odometry_into(full);
  const auto kept = kept_poses(full, into);
  CompressedTeam<Pose> result;
  std::vector<PoseId> new_id(full.graph.poses.size());
  result.team.graph.chart = full.graph.chart;
  result.team.graph.points = full.graph.points;
  result.team.graph.drifts = full.graph.drifts;
  for (const TrajectorySegment& segment : full.segments)
    result.team.segments.push_back(compress_segment(full, segment, into, kept, result, new_id));
  for (std::size_t k = 0; k < full.graph.relative_poses.size(); ++k) {
    auto factor = full.graph.relative_poses[k];
    if (into[factor.j.index()] == static_cast<std::int32_t>(k)) continue;
    factor.i = new_id[factor.i.index()];
    factor.j = new_id[factor.j.index()];
    result.team.graph.relative_poses.push_back(factor);
  }
  copy_other_factors(full, new_id, result.team);
  return result;
}

template <class Pose>
void expand_values(const CompressedTeam<Pose>& compressed, TeamGraph<Pose>& full) {
  const auto into = odometry_into(full);
  const auto& values = compressed.team.graph;
  full.graph.points = values.points;
  full.graph.drifts = values.drifts;
  std::vector<bool> known(full.graph.poses.size(), false);
  for (std::size_t k = 0; k < compressed.full_pose.size(); ++k) {
    full.graph.poses[compressed.full_pose[k].index()] = values.poses[k];
    known[compressed.full_pose[k].index()] = true;
  }
  for (std::size_t k = 0; k < known.size(); ++k)
    if (!known[k])
      full.graph.poses[k] =
          full.graph.poses[k - 1] * full.graph.relative_poses[static_cast<std::size_t>(into[k])].T_i_j;
}

template std::vector<std::int32_t> odometry_into(const TeamGraph<SE2>&);
template std::vector<std::int32_t> odometry_into(const TeamGraph<SE3>&);
template CompressedTeam<SE2> compress(const TeamGraph<SE2>&);
template CompressedTeam<SE3> compress(const TeamGraph<SE3>&);
template void expand_values(const CompressedTeam<SE2>&, TeamGraph<SE2>&);
template void expand_values(const CompressedTeam<SE3>&, TeamGraph<SE3>&);

}  // namespace radioslam
