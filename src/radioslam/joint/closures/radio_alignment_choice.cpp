#include "radioslam/joint/closures/radio_alignment_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/joint/closures/map_contradictions.hpp"
#include "radioslam/joint/links/link_weights.hpp"
#include "radioslam/joint/uncertainty/position_uncertainty.hpp"
#include "radioslam/team_frame/beam_search/beam_selection.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinProposing = 3;   // loops of a group that proposes an alignment
constexpr std::size_t kMaxProposals = 24;  // per round
constexpr std::size_t kMaxGroups = 40;     // per pair of robots
constexpr double kNoTrueGroup = 4;         // weight, in loops, of the case that no group is true

/// Error of a loop under an estimate, with its covariance: x, y and yaw.
struct PlanarError {
  Eigen::Vector3d error;
  Eigen::Matrix3d covariance;

  double squared_norm() const { return Cholesky<Eigen::Matrix3d>(covariance).whitened(error).squaredNorm(); }
};

template <class Pose>
PlanarError planar_error(const std::vector<Pose>& poses, const Marginals<Pose>& marginals, double temperature,
                         const TeamLoop<Pose>& loop) {
  const Pose T_i_j = poses[loop.i.index()].inverse() * poses[loop.j.index()];
  const typename Pose::Tangent error = (loop.T_i_j.inverse() * T_i_j).log();
  const typename Pose::Jacobian covariance =
      temperature * marginals.relative_pose(loop.i, loop.j) + loop.covariance;
  if constexpr (Pose::kDim == 2) {
    return {error, covariance};
  } else {
    const std::array<int, 3> kept{0, 1, 5};
    return {error(kept), covariance(kept, kept)};
  }
}

std::size_t loops_of_pair(const std::vector<LoopGroup>& groups, const LoopGroup& of) {
  std::size_t count = 0;
  for (const LoopGroup& group : groups)
    if (group.segment_a == of.segment_a && group.segment_b == of.segment_b) count += group.loops.size();
  return count;
}

/// Sum of the diameters of the two trajectories.
template <class Pose>
double span_m(const JointGraph<Pose>& joint, const LoopGroup& group) {
  double sum = 1;
  for (const std::size_t segment : {group.segment_a, group.segment_b}) {
    typename Pose::Point low = Pose::Point::Constant(1e300), high = -low;
    for (const SE3& pose : joint.robots[joint.robot_of_segment[segment]].odometry) {
      const typename Pose::Point p = pose.translation().template head<Pose::kDim>();
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    sum += (high - low).norm();
  }
  return sum;
}

/// Moves the robot of a segment, one of the loop's, to where the loop wants it.
template <class Pose>
std::vector<Pose> moved_to(const JointGraph<Pose>& joint, const TeamLoop<Pose>& loop, std::size_t moved,
                           std::vector<Pose> poses) {
  const Pose T = motion_to_hold(poses, loop, moved);
  for (std::size_t s = 0; s < joint.team.segments.size(); ++s)
    if (joint.robot_of_segment[s] == joint.robot_of_segment[moved])
      move_segment(poses, joint.team.segments[s], T);
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
                  const std::vector<TeamLoop<Pose>>& loops, const std::vector<LoopGroup>& groups,
                  const RadioAlignmentParams& params)
      : joint_(joint),
        alignment_(alignment),
        loops_(loops),
        groups_(groups),
        params_(params),
        radio_(radio_team(joint)) {}

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

  PlanarError group_error(const Aligned& at, const LoopGroup& group) const {
    return planar_error(at.joint.team.graph.poses, *at.marginals, params_.beam.evidence_temperature,
                        loops_[group.middle()]);
  }

  double log_weight(const TeamHypothesis<Pose>& alignment) const {
    double result = alignment.log_evidence / params_.beam.evidence_temperature;
    const Aligned at = aligned(alignment);
    if (!at.marginals) return result;
    std::map<std::pair<std::size_t, std::size_t>, double> largest_ratio;
    for (const LoopGroup& group : groups_) {
      if (!share_frame(group)) continue;
      double& ratio = largest_ratio[{group.segment_a, group.segment_b}];
      ratio = std::max(ratio, std::exp(log_ratio(at, group)));
    }
    for (const auto& [segments, ratio] : largest_ratio) result += std::log1p(ratio);
    return result;
  }

  /// log r_G.
  double log_ratio(const Aligned& at, const LoopGroup& group) const {
    const auto [error, covariance] = group_error(at, group);
    const Cholesky<Eigen::Matrix3d> root(covariance);
    if (!root.succeeded()) return -std::numeric_limits<double>::infinity();
    const double log_density = -root.whitened(error).squaredNorm() / 2 -
                               root.lower().diagonal().array().log().sum() -
                               1.5 * std::log(2 * std::numbers::pi);
    const double log_uniform = -2 * std::log(span_m(joint_, group)) - std::log(2 * std::numbers::pi);
    return log_density - log_uniform +
           std::log(static_cast<double>(group.loops.size()) /
                    (static_cast<double>(loops_of_pair(groups_, group)) + kNoTrueGroup));
  }

  RobotIndex robot(std::size_t segment) const { return RobotIndex(joint_.robot_of_segment[segment]); }

  bool share_frame(const LoopGroup& group) const {
    const RobotIndex a = robot(group.segment_a), b = robot(group.segment_b);
    return a != b && connected_without_matches(alignment_, a, b);
  }

  bool is_known(std::size_t segment) const {
    return joint_.robots[robot(segment).index()].T_common_start.has_value();
  }

  /// Poses with one robot moved to where a group wants it, for the largest groups that contradict the
  /// candidate.
  std::vector<std::vector<Pose>> proposals(const Candidate<Pose>& candidate) const {
    std::vector<std::vector<Pose>> starts;
    const Aligned at = aligned(candidate.alignment);
    if (!at.marginals) return starts;
    std::vector<const LoopGroup*> contradicting;
    for (const LoopGroup& group : groups_) {
      const bool is_fixed = is_known(group.segment_a) && is_known(group.segment_b);
      if (group.loops.size() < kMinProposing || !share_frame(group) || is_fixed) continue;
      if (group_error(at, group).squared_norm() > kPoseChiSquared999<SE2>) contradicting.push_back(&group);
    }
    std::stable_sort(contradicting.begin(), contradicting.end(),
                     [](const auto* x, const auto* y) { return x->loops.size() > y->loops.size(); });
    if (contradicting.size() > kMaxProposals) contradicting.resize(kMaxProposals);
    for (const LoopGroup* group : contradicting)
      starts.push_back(moved_to(joint_, loops_[group->middle()],
                                is_known(group->segment_b) ? group->segment_a : group->segment_b,
                                candidate.alignment.poses));
    return starts;
  }

  const JointGraph<Pose>& joint_;
  const TeamAlignment<Pose>& alignment_;
  const std::vector<TeamLoop<Pose>>& loops_;
  const std::vector<LoopGroup>& groups_;
  const RadioAlignmentParams& params_;
  TeamGraph<Pose> radio_;
  std::vector<Candidate<Pose>> candidates_;
};

}  // namespace

template <class Pose>
bool choose_alignment_by_loops(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                               const std::vector<Closure>& closures, const RadioAlignmentParams& params,
                               const ConsistencyParams& consistency, const MapWitness* maps) {
  if (alignment.segments.of_segment.empty()) return false;
  const std::vector<TeamLoop<Pose>> loops = team_loops(joint, closures);
  if (std::all_of(loops.begin(), loops.end(), [](const auto& loop) { return loop.is_own(); })) return false;
  const auto groups = held_against_maps(maps, closures, loops,
                                        loop_groups(joint, loops, segment_chains(joint, loops, 1),
                                                    {.max_groups = kMaxGroups, .consistency = consistency}));
  const auto alignments = AlignmentChoice<Pose>(joint, alignment, loops, groups, params).run();
  if (alignments.empty()) return false;
  set_alternatives(alignment, alignments);
  const TeamHypothesis<Pose>& chosen = alignments.front();
  if (same_alignment(joint.team.graph.poses, chosen.poses, {}, params.beam)) return false;
  adopt_alignment(joint, chosen);
  return true;
}

#define RADIOSLAM_RADIO_ALIGNMENT_CHOICE(Pose)                                                      \
  template bool choose_alignment_by_loops(JointGraph<Pose>&, TeamAlignment<Pose>&,                  \
                                          const std::vector<Closure>&, const RadioAlignmentParams&, \
                                          const ConsistencyParams&, const MapWitness*);
RADIOSLAM_RADIO_ALIGNMENT_CHOICE(SE2)
RADIOSLAM_RADIO_ALIGNMENT_CHOICE(SE3)
#undef RADIOSLAM_RADIO_ALIGNMENT_CHOICE

}  // namespace radioslam
