#include "radioslam/joint/matches/alignment_by_matches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/joint/links/link_weights.hpp"
#include "radioslam/joint/matches/match_groups.hpp"
#include "radioslam/joint/uncertainty/position_uncertainty.hpp"
#include "radioslam/team_frame/beam_search/beam_selection.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinMatches = 3;
constexpr std::size_t kMinRatioToSecond = 2;
constexpr std::size_t kGroups = 2;  // the largest and its best alternative

struct PairOfRobots {
  MatchGroup largest;
  std::size_t second = 0;  ///< size of the second group
  std::size_t matches = 0;

  bool is_clear() const {
    return largest.matches.size() >= kMinMatches && largest.matches.size() >= kMinRatioToSecond * second;
  }
};

template <class Pose>
std::vector<PairOfRobots> pairs_of_robots(const JointGraph<Pose>& joint,
                                          const std::vector<Closure>& matches) {
  std::map<std::pair<RobotIndex, RobotIndex>, PairOfRobots> pairs;
  for (MatchGroup& group : consistent_groups(joint, matches, kGroups)) {
    PairOfRobots& pair = pairs[{group.a, group.b}];
    if (pair.largest.matches.empty())
      pair.largest = std::move(group);
    else
      pair.second = group.matches.size();
  }
  for (const Closure& match : matches) {
    const auto found = pairs.find(std::minmax(match.robot_i, match.robot_j));
    if (found != pairs.end()) ++found->second.matches;
  }
  std::vector<PairOfRobots> result;
  for (auto& [robots, pair] : pairs) result.push_back(std::move(pair));
  std::stable_sort(result.begin(), result.end(), [](const auto& x, const auto& y) {
    return x.largest.matches.size() > y.largest.matches.size();
  });
  return result;
}

/// Moves the component of the group's robot b to where the middle match wants it.
template <class Pose>
void join(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment, const std::vector<Closure>& matches,
          const MatchGroup& group) {
  // A component in the common frame stays where it is.
  const auto absolute = [&](RobotIndex robot) {
    return static_cast<bool>(
        alignment.absolute[static_cast<std::size_t>(alignment.component[robot.index()])]);
  };
  const RobotIndex moved = absolute(group.b) ? group.a : group.b,
                   fixed = absolute(group.b) ? group.b : group.a;
  const Closure& match = matches[group.middle().match];
  const int from = alignment.component[moved.index()], to = alignment.component[fixed.index()];
  const auto move = [&](std::vector<Pose>& poses) {
    const Pose T = motion_to_match(poses, match, group.middle(), moved);
    for (std::size_t p = 0; p < joint.team.segments.size(); ++p)
      if (alignment.of_segment[p] == from) move_segment(poses, joint.team.segments[p], T);
  };
  move(joint.team.graph.poses);
  for (std::vector<Pose>& alternative : alignment.alternatives) move(alternative);
  std::replace(alignment.of_segment.begin(), alignment.of_segment.end(), from, to);
  for (std::size_t r = 0; r < alignment.component.size(); ++r)
    if (alignment.component[r] == from || alignment.component[r] == to) {
      alignment.component[r] = to;
      alignment.placed[r] = true;
    }
}

template <class Pose>
std::string names(const JointGraph<Pose>& joint, const PairOfRobots& pair) {
  return joint.robots[pair.largest.a.index()].id + " and " + joint.robots[pair.largest.b.index()].id;
}

std::string counts(const PairOfRobots& pair) {
  return std::to_string(pair.largest.matches.size()) + " of " + std::to_string(pair.matches) + " matches";
}

template <class Pose>
void renumber(const JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment) {
  const std::vector<bool> before = alignment.absolute;
  const std::vector<int> number = set_components(joint, std::vector<int>(alignment.of_segment), alignment);
  alignment.absolute.assign(before.size(), false);
  for (std::size_t c = 0; c < number.size(); ++c)
    if (number[c] >= 0) alignment.absolute[static_cast<std::size_t>(number[c])] = before[c];
}

}  // namespace

template <class Pose>
void join_by_matches(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                     const std::vector<Closure>& matches) {
  const auto& component = alignment.component;
  if (std::all_of(component.begin(), component.end(), [&](int c) { return c == component.front(); })) return;
  const auto share_frame = [&](const PairOfRobots& pair) {
    return component[pair.largest.a.index()] == component[pair.largest.b.index()];
  };
  const auto both_absolute = [&](const PairOfRobots& pair) {
    return alignment.absolute[static_cast<std::size_t>(component[pair.largest.a.index()])] &&
           alignment.absolute[static_cast<std::size_t>(component[pair.largest.b.index()])];
  };
  const std::vector<PairOfRobots> pairs = pairs_of_robots(joint, matches);
  bool is_joined = false;
  for (const PairOfRobots& pair : pairs) {
    if (!pair.is_clear() || share_frame(pair) || both_absolute(pair)) continue;
    alignment.notes.push_back("the relative pose of " + names(joint, pair) +
                              " stands on matches alone: " + counts(pair) + " agree with one another");
    join(joint, alignment, matches, pair.largest);
    is_joined = true;
  }
  for (const PairOfRobots& pair : pairs)
    if (!pair.is_clear() && !share_frame(pair) && !both_absolute(pair))
      alignment.notes.push_back("matches leave the relative pose of " + names(joint, pair) +
                                " open: the largest group that agrees has " + counts(pair) + ", the second " +
                                std::to_string(pair.second));
  if (is_joined) renumber(joint, alignment);
}

template void join_by_matches(JointGraph<SE2>&, TeamAlignment<SE2>&, const std::vector<Closure>&);
template void join_by_matches(JointGraph<SE3>&, TeamAlignment<SE3>&, const std::vector<Closure>&);

namespace {

constexpr std::size_t kMinProposing = 3;   // matches of a group that proposes an alignment
constexpr std::size_t kMaxProposals = 24;  // per round
constexpr std::size_t kMaxGroups = 40;     // per pair of robots
constexpr double kNoTrueGroup = 4;         // weight, in matches, of the case that no group is true

/// Error of a match under an estimate, with its covariance.
template <class Pose>
struct MatchError {
  typename Pose::Tangent error;
  typename Pose::Jacobian covariance;

  /// x, y and yaw.
  std::pair<Eigen::Vector3d, Eigen::Matrix3d> planar() const {
    if constexpr (Pose::kDim == 2) {
      return {error, covariance};
    } else {
      const std::array<int, 3> kept{0, 1, 5};
      return {error(kept), covariance(kept, kept)};
    }
  }
};

template <class Pose>
MatchError<Pose> match_error(const JointGraph<Pose>& joint, const Marginals<Pose>& marginals,
                             double temperature, const Closure& match, const MatchEnds& ends) {
  const auto& poses = joint.team.graph.poses;
  const Pose T_i_j = poses[ends.i.index()].inverse() * poses[ends.j.index()];
  return {(pose_as<Pose>(match.T_i_j).inverse() * T_i_j).log(),
          temperature * marginals.relative_pose(ends.i, ends.j) + covariance_of<Pose>(match)};
}

template <class Vector, class Matrix>
double squared_mahalanobis(const Vector& error, const Matrix& covariance) {
  return Cholesky<Matrix>(covariance).whitened(error).squaredNorm();
}

std::size_t matches_of_pair(const std::vector<MatchGroup>& groups, const MatchGroup& of) {
  std::size_t count = 0;
  for (const MatchGroup& group : groups)
    if (group.a == of.a && group.b == of.b) count += group.matches.size();
  return count;
}

/// Sum of the diameters of the two trajectories.
template <class Pose>
double span_m(const JointGraph<Pose>& joint, const MatchGroup& group) {
  double sum = 1;
  for (const RobotIndex robot : {group.a, group.b}) {
    typename Pose::Point low = Pose::Point::Constant(1e300), high = -low;
    for (const SE3& pose : joint.robots[robot.index()].odometry) {
      const typename Pose::Point p = pose.translation().template head<Pose::kDim>();
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    sum += (high - low).norm();
  }
  return sum;
}

/// Moves robot b of the group, or a if b's start is known, to where the group's middle match wants it.
template <class Pose>
std::vector<Pose> moved_by(const JointGraph<Pose>& joint, const std::vector<Closure>& matches,
                           const MatchGroup& group, std::vector<Pose> poses) {
  const RobotIndex moved = joint.robots[group.b.index()].T_common_start ? group.a : group.b;
  const Pose T = motion_to_match(poses, matches[group.middle().match], group.middle(), moved);
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p)
    if (joint.robot_of_segment[p] == moved.index()) move_segment(poses, joint.team.segments[p], T);
  return poses;
}

/// One alignment of the team and its weight.
template <class Pose>
struct Candidate {
  TeamHypothesis<Pose> alignment;
  double log_weight = 0;
};

template <class Pose>
class AlignmentChoice {
 public:
  AlignmentChoice(const JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment,
                  const std::vector<Closure>& matches, const RadioAlignmentParams& params)
      : joint_(joint),
        alignment_(alignment),
        matches_(matches),
        params_(params),
        radio_(radio_team(joint)),
        groups_(consistent_groups(joint, matches, kMaxGroups)) {}

  /// The alignments with their weights, best first; the radio's own is the first of equals.
  std::vector<TeamHypothesis<Pose>> run() {
    add(joint_.team.graph.poses);
    for (const std::vector<Pose>& poses : alignment_.alternatives) add(poses);
    if (candidates_.empty()) return {};
    for (std::size_t round = 1; round < joint_.robots.size(); ++round) {
      const std::size_t before = best();
      for (const std::vector<Pose>& start : proposals(candidates_[before])) add(start);
      if (best() == before) break;
    }
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const auto& x, const auto& y) { return x.log_weight > y.log_weight; });
    return weighted();
  }

 private:
  std::vector<TeamHypothesis<Pose>> weighted() {
    std::vector<TeamHypothesis<Pose>> result;
    double sum = 0;
    for (Candidate<Pose>& candidate : candidates_) {
      candidate.alignment.weight = std::exp(candidate.log_weight - candidates_.front().log_weight);
      sum += candidate.alignment.weight;
      result.push_back(std::move(candidate.alignment));
    }
    for (TeamHypothesis<Pose>& alignment : result) alignment.weight /= sum;
    return result;
  }

  /// Refines the alignment from these poses and keeps it unless a candidate is the same.
  void add(const std::vector<Pose>& poses) {
    TeamGraph<Pose> start = radio_;
    start.graph.poses = poses;
    Candidate<Pose> candidate{refine_alignment(start, alignment_.segments, params_)};
    if (!std::isfinite(candidate.alignment.log_evidence)) return;
    const auto is_same = [&](const Candidate<Pose>& other) {
      return same_alignment(other.alignment.poses, candidate.alignment.poses, {}, params_.beam);
    };
    if (std::any_of(candidates_.begin(), candidates_.end(), is_same)) return;
    candidate.log_weight = log_weight(candidate.alignment);
    candidates_.push_back(std::move(candidate));
  }

  std::size_t best() const {
    const auto found =
        std::max_element(candidates_.begin(), candidates_.end(),
                         [](const auto& x, const auto& y) { return x.log_weight < y.log_weight; });
    return static_cast<std::size_t>(found - candidates_.begin());
  }

  /// The joint graph at an alignment, with its covariances.
  struct Aligned {
    JointGraph<Pose> joint;
    std::optional<Marginals<Pose>> marginals;
  };
  Aligned aligned(const TeamHypothesis<Pose>& alignment) const {
    JointGraph<Pose> joint = joint_;
    joint.team.graph.ranges = radio_.graph.ranges;
    std::erase_if(joint.origins.ranges,
                  [](const FactorOrigin& o) { return o.source != FactorSource::kRange; });
    adopt_alignment(joint, alignment);
    auto marginals = Marginals<Pose>::compute(graph_for_covariances(joint, params_.mixture).team.graph);
    return {std::move(joint), std::move(marginals)};
  }

  /// Planar error of the group's middle match.
  MatchError<Pose> group_error(const Aligned& at, const MatchGroup& group) const {
    return match_error(at.joint, *at.marginals, params_.beam.evidence_temperature,
                       matches_[group.middle().match], group.middle());
  }

  double log_weight(const TeamHypothesis<Pose>& alignment) const {
    double result = alignment.log_evidence / params_.beam.evidence_temperature;
    const Aligned at = aligned(alignment);
    if (!at.marginals) return result;
    std::map<std::pair<RobotIndex, RobotIndex>, double> largest_ratio;
    for (const MatchGroup& group : groups_) {
      if (!share_frame(group)) continue;
      double& ratio = largest_ratio[{group.a, group.b}];
      ratio = std::max(ratio, std::exp(log_ratio(at, group)));
    }
    for (const auto& [robots, ratio] : largest_ratio) result += std::log1p(ratio);
    return result;
  }

  /// log r_G.
  double log_ratio(const Aligned& at, const MatchGroup& group) const {
    const auto [error, covariance] = group_error(at, group).planar();
    const Cholesky<Eigen::Matrix3d> root(covariance);
    if (!root.succeeded()) return -std::numeric_limits<double>::infinity();
    const double log_density = -root.whitened(error).squaredNorm() / 2 -
                               root.lower().diagonal().array().log().sum() -
                               1.5 * std::log(2 * std::numbers::pi);
    const double log_uniform = -2 * std::log(span_m(joint_, group)) - std::log(2 * std::numbers::pi);
    return log_density - log_uniform +
           std::log(static_cast<double>(group.matches.size()) /
                    (static_cast<double>(matches_of_pair(groups_, group)) + kNoTrueGroup));
  }

  bool share_frame(const MatchGroup& group) const {
    return connected_without_matches(alignment_, group.a, group.b);
  }

  /// Poses with one robot moved to where a group wants it, for the largest groups that contradict the
  /// candidate.
  std::vector<std::vector<Pose>> proposals(const Candidate<Pose>& candidate) const {
    std::vector<std::vector<Pose>> starts;
    const Aligned at = aligned(candidate.alignment);
    if (!at.marginals) return starts;
    std::vector<const MatchGroup*> contradicting;
    for (const MatchGroup& group : groups_) {
      if (group.matches.size() < kMinProposing || !share_frame(group) || both_known(group)) continue;
      const auto [error, covariance] = group_error(at, group).planar();
      if (squared_mahalanobis(error, covariance) > kPoseChiSquared999<SE2>) contradicting.push_back(&group);
    }
    std::stable_sort(contradicting.begin(), contradicting.end(),
                     [](const auto* x, const auto* y) { return x->matches.size() > y->matches.size(); });
    if (contradicting.size() > kMaxProposals) contradicting.resize(kMaxProposals);
    for (const MatchGroup* group : contradicting)
      starts.push_back(moved_by(joint_, matches_, *group, candidate.alignment.poses));
    return starts;
  }

  bool both_known(const MatchGroup& group) const {
    return joint_.robots[group.a.index()].T_common_start && joint_.robots[group.b.index()].T_common_start;
  }

  const JointGraph<Pose>& joint_;
  const TeamAlignment<Pose>& alignment_;
  const std::vector<Closure>& matches_;
  const RadioAlignmentParams& params_;
  TeamGraph<Pose> radio_;
  std::vector<MatchGroup> groups_;
  std::vector<Candidate<Pose>> candidates_;
};

}  // namespace

template <class Pose>
double match_statistic(const JointGraph<Pose>& joint, const Marginals<Pose>& marginals, double temperature,
                       const Closure& match, const MatchEnds& ends) {
  const MatchError<Pose> at = match_error(joint, marginals, temperature, match, ends);
  return squared_mahalanobis(at.error, at.covariance);
}

template <class Pose>
bool choose_alignment_by_matches(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                                 const std::vector<Closure>& matches, const RadioAlignmentParams& params) {
  if (alignment.segments.of_segment.empty() || matches.empty()) return false;
  const auto alignments = AlignmentChoice<Pose>(joint, alignment, matches, params).run();
  if (alignments.empty()) return false;
  set_alternatives(alignment, alignments);
  const TeamHypothesis<Pose>& chosen = alignments.front();
  if (same_alignment(joint.team.graph.poses, chosen.poses, {}, params.beam)) return false;
  adopt_alignment(joint, chosen);
  return true;
}

#define RADIOSLAM_ALIGNMENT_BY_MATCHES(Pose)                                                               \
  template double match_statistic(const JointGraph<Pose>&, const Marginals<Pose>&, double, const Closure&, \
                                  const MatchEnds&);                                                       \
  template bool choose_alignment_by_matches(JointGraph<Pose>&, TeamAlignment<Pose>&,                       \
                                            const std::vector<Closure>&, const RadioAlignmentParams&);
RADIOSLAM_ALIGNMENT_BY_MATCHES(SE2)
RADIOSLAM_ALIGNMENT_BY_MATCHES(SE3)
#undef RADIOSLAM_ALIGNMENT_BY_MATCHES

}  // namespace radioslam
