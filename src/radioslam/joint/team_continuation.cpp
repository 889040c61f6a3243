#include "radioslam/joint/team_continuation.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "radioslam/team_frame/alignment_continuity.hpp"

namespace radioslam {
namespace {

/// Which robots and poses of a graph are which of another one, of the same team.
class Correspondence {
 public:
  template <class Pose>
  Correspondence(const JointGraph<Pose>& before, const JointGraph<Pose>& now)
      : robots_(now.robots.size()), poses_(before.team.graph.poses.size()) {
    for (std::size_t r = 0; r < now.robots.size(); ++r)
      for (std::size_t b = 0; b < before.robots.size(); ++b)
        if (before.robots[b].id == now.robots[r].id) robots_[r] = b;
    for (std::size_t r = 0; r < now.robots.size(); ++r)
      if (robots_[r]) add(before.robots[*robots_[r]], now.robots[r]);
  }

  /// Of robot r now, the number before.
  std::optional<std::size_t> robot_before(std::size_t r) const { return robots_[r]; }
  /// Invalid if it is no longer known.
  PoseId now(PoseId before) const { return before.valid() ? poses_[before.index()] : before; }
  bool has_all() const {
    return std::all_of(poses_.begin(), poses_.end(), [](PoseId pose) { return pose.valid(); });
  }

 private:
  void add(const RobotVariables& before, const RobotVariables& now) {
    for (std::size_t k = 0, n = 0; k < before.stamps.size(); ++k) {
      while (n < now.stamps.size() && now.stamps[n] < before.stamps[k]) ++n;
      if (n < now.stamps.size() && now.stamps[n] == before.stamps[k])
        poses_[before.poses[k].index()] = now.poses[n];
    }
  }

  std::vector<std::optional<std::size_t>> robots_;
  std::vector<PoseId> poses_;
};

/// The poses of a newly built graph at the values `before` of another one's.
template <class Pose>
std::vector<Pose> carried_poses(const Correspondence& same, const std::vector<Pose>& before,
                                const JointGraph<Pose>& joint) {
  std::vector<Pose> poses = joint.team.graph.poses;
  std::vector<bool> is_known(poses.size(), false);
  for (std::size_t k = 0; k < before.size(); ++k)
    if (const PoseId now = same.now(PoseId(k)); now.valid()) {
      poses[now.index()] = before[k];
      is_known[now.index()] = true;
    }
  for (const TrajectorySegment& segment : joint.team.segments) {
    const std::size_t end = segment.first_pose + segment.pose_count;
    const auto step = [&](std::size_t k) {
      return joint.team.graph.poses[k - 1].inverse() * joint.team.graph.poses[k];
    };
    std::size_t first = segment.first_pose;
    while (first < end && !is_known[first]) ++first;
    if (first == end) continue;
    for (std::size_t k = first; k > segment.first_pose; --k) poses[k - 1] = poses[k] * step(k).inverse();
    for (std::size_t k = first + 1; k < end; ++k)
      if (!is_known[k]) poses[k] = poses[k - 1] * step(k);
  }
  return poses;
}

template <class Pose>
void carry_values(const Correspondence& same, const JointGraph<Pose>& before, JointGraph<Pose>& joint) {
  joint.team.graph.poses = carried_poses(same, before.team.graph.poses, joint);
  if (before.team.graph.points.size() == joint.team.graph.points.size())
    joint.team.graph.points = before.team.graph.points;
  for (std::size_t r = 0; r < joint.robots.size(); ++r) {
    const DriftId drift = joint.robots[r].drift;
    const auto robot = same.robot_before(r);
    if (!robot || !drift.valid() || !before.robots[*robot].drift.valid()) continue;
    joint.team.graph.drifts[drift.index()] = before.team.graph.drifts[before.robots[*robot].drift.index()];
  }
}

/// The segment that every segment was before.
template <class Pose>
std::vector<std::optional<std::size_t>> segments_before(const Correspondence& same,
                                                        const JointGraph<Pose>& before,
                                                        const JointGraph<Pose>& joint) {
  const auto segment_of = segment_of_poses(joint.team);
  std::vector<std::optional<std::size_t>> of(joint.team.segments.size());
  for (std::size_t s = before.team.segments.size(); s-- > 0;) {
    const PoseId first = same.now(PoseId(before.team.segments[s].first_pose));
    if (first.valid()) of[segment_of[first.index()]] = s;
  }
  return of;
}

/// The frames before of what is now; those that are new have the next numbers.
std::vector<int> carried_frames(const std::vector<int>& before,
                                const std::vector<std::optional<std::size_t>>& of) {
  int next = before.empty() ? 0 : 1 + *std::max_element(before.begin(), before.end());
  std::vector<int> now;
  for (const auto& known : of) now.push_back(known && *known < before.size() ? before[*known] : next++);
  return now;
}

template <class Pose>
TeamAlignment<Pose> carried_alignment(const Correspondence& same, const TeamEstimate<Pose>& before,
                                      const JointGraph<Pose>& joint) {
  const TeamAlignment<Pose>& known = before.alignment;
  TeamAlignment<Pose> now = known;
  const auto of_segment = segments_before(same, before.joint, joint);
  std::vector<std::optional<std::size_t>> of_robot;
  for (std::size_t r = 0; r < joint.robots.size(); ++r) of_robot.push_back(same.robot_before(r));
  if (!known.segments.of_segment.empty()) {
    now.segments.of_segment = carried_frames(known.segments.of_segment, of_segment);
    now.segments.of_point.resize(joint.team.graph.points.size(), -1);
  }
  now.of_segment = carried_frames(known.of_segment, of_segment);
  now.component = carried_frames(known.component, of_robot);
  now.without_matches = carried_frames(known.without_matches, of_robot);
  now.absolute.resize(
      1 + static_cast<std::size_t>(*std::max_element(now.component.begin(), now.component.end())), false);
  const auto flags = [&](const std::vector<bool>& of) {
    std::vector<bool> carried;
    for (const auto& robot : of_robot) carried.push_back(robot && *robot < of.size() && of[*robot]);
    return carried;
  };
  now.in_common_frame = flags(known.in_common_frame);
  now.placed = flags(known.placed);
  for (auto& poses : now.alternatives) poses = carried_poses(same, poses, joint);
  return now;
}

/// Factors of a graph, appended to those of the same team's.
template <class Pose>
class CarriedFactors {
 public:
  CarriedFactors(const Correspondence& same, const JointGraph<Pose>& before, JointGraph<Pose>& joint)
      : same_(same), before_(before), joint_(joint) {}

  void add() {
    add_relative_poses();
    add_ranges();
    const auto& graph = before_.team.graph;
    for (auto position : graph.positions)
      if (position.i.pose.valid()) {
        position.i = moved(position.i);
        joint_.team.graph.positions.push_back(position);
      }
    joint_.team.graph.range_biases = graph.range_biases;
    joint_.team.graph.range_bias_priors = graph.range_bias_priors;
    carry_biases();
  }

 private:
  RangeEnd<Pose> moved(RangeEnd<Pose> end) const {
    end.pose = same_.now(end.pose);
    return end;
  }

  /// Those other than odometry, which has the variances that were found before.
  void add_relative_poses() {
    const auto& factors = before_.team.graph.relative_poses;
    std::vector<std::pair<RelativePoseFactor<Pose>, FactorOrigin>> others;
    std::map<std::size_t, double> scale;  // by robot
    std::map<std::pair<std::size_t, Stamp>, const RelativePoseFactor<Pose>*> steps;
    const auto key = [](const FactorOrigin& origin) {
      return std::pair(origin.robot_i.index(), origin.stamp_j);
    };
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const FactorOrigin& origin = before_.origins.relative_poses[k];
      if (origin.source == FactorSource::kOdometry) {
        steps.emplace(key(origin), &factors[k]);
        continue;
      }
      RelativePoseFactor<Pose> factor = factors[k];
      factor.i = same_.now(factor.i);
      factor.j = same_.now(factor.j);
      others.emplace_back(factor, origin);
    }
    auto& graph = joint_.team.graph;
    for (std::size_t k = 0; k < graph.relative_poses.size(); ++k) {
      const FactorOrigin& origin = joint_.origins.relative_poses[k];
      const RelativePoseFactor<Pose>& now = graph.relative_poses[k];
      const auto known = steps.find(key(origin));
      const bool is_amended =
          known == steps.end() || !(known->second->T_i_j.inverse() * now.T_i_j).log().isZero();
      if (is_amended || !(now.information(0, 0) > 0)) continue;
      scale.emplace(origin.robot_i.index(), known->second->information(0, 0) / now.information(0, 0));
    }
    for (std::size_t k = 0; k < graph.relative_poses.size(); ++k)
      if (const auto of = scale.find(joint_.origins.relative_poses[k].robot_i.index()); of != scale.end())
        graph.relative_poses[k].information *= of->second;
    for (const auto& [factor, origin] : others) add_factor(joint_, factor, origin);
  }

  void add_ranges() {
    const auto& ranges = before_.team.graph.ranges;
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      if (before_.origins.ranges[k].source == FactorSource::kRange) continue;
      RangeFactor<Pose> range = ranges[k];
      range.i = moved(range.i);
      range.j = moved(range.j);
      add_factor(joint_, range, before_.origins.ranges[k]);
    }
  }

  /// The biases of the antennas' ranges.
  void carry_biases() {
    std::map<std::pair<std::string, std::string>, BiasId> bias;
    for (const std::size_t k : factors_of(before_.origins.ranges, FactorSource::kRange))
      bias[before_.antenna_pairs[before_.origins.ranges[k].antenna_pair]] = before_.team.graph.ranges[k].bias;
    for (const std::size_t k : factors_of(joint_.origins.ranges, FactorSource::kRange))
      if (const auto known = bias.find(joint_.antenna_pairs[joint_.origins.ranges[k].antenna_pair]);
          known != bias.end())
        joint_.team.graph.ranges[k].bias = known->second;
  }

  const Correspondence& same_;
  const JointGraph<Pose>& before_;
  JointGraph<Pose>& joint_;
};

}  // namespace

template <class Pose>
void carry_values(const JointGraph<Pose>& before, JointGraph<Pose>& joint) {
  carry_values(Correspondence(before, joint), before, joint);
}

template <class Pose>
TeamAlignment<Pose> carried_alignment(const TeamEstimate<Pose>& before, const JointGraph<Pose>& joint) {
  return carried_alignment(Correspondence(before.joint, joint), before, joint);
}

template <class Pose>
std::optional<TeamEstimate<Pose>> extended(const TeamEstimate<Pose>& before, JointGraph<Pose> joint) {
  const Correspondence same(before.joint, joint);
  if (!are_same_robots(before.joint.robots, joint.robots) || !same.has_all()) return std::nullopt;
  TeamEstimate<Pose> team{before.measured, carried_alignment(same, before, joint), before.judgement, {}, {}};
  CarriedFactors<Pose>(same, before.joint, joint).add();
  carry_values(same, before.joint, joint);
  for (std::size_t r = 0; r < joint.robots.size(); ++r)
    joint.robots[r].placed_by_fixes = before.joint.robots[r].placed_by_fixes;
  team.joint = std::move(joint);
  return team;
}

template <class Pose>
std::vector<int> settled_components(const TeamEstimate<Pose>& team, double certainty) {
  const TeamAlignment<Pose>& alignment = team.alignment;
  const auto& segments = team.joint.team.segments;
  std::vector<int> component = alignment.component;
  double weight = alignment.weight;
  for (std::size_t k = 0; k < alignment.alternatives.size() && weight < certainty; ++k) {
    weight += alignment.alternative_weights[k];
    const std::vector<int> before = component;
    int next = 1 + *std::max_element(before.begin(), before.end());
    for (std::size_t r = 1; r < component.size(); ++r) {
      const auto stays_with = [&](std::size_t other) {
        std::vector<int> frames(segments.size(), -1);
        for (std::size_t s = 0; s < segments.size(); ++s)
          if (team.joint.robot_of_segment[s] == r || team.joint.robot_of_segment[s] == other) frames[s] = 0;
        return before[other] == before[r] &&
               agree(team.joint.team.graph.poses, alignment.alternatives[k], segments, frames);
      };
      std::size_t other = 0;
      while (other < r && !stays_with(other)) ++other;
      const bool is_first = std::find(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(r),
                                      before[r]) == before.begin() + static_cast<std::ptrdiff_t>(r);
      if (!is_first) component[r] = other < r ? component[other] : next++;
    }
  }
  return component;
}

#define RADIOSLAM_TEAM_CONTINUATION(Pose)                                                             \
  template void carry_values(const JointGraph<Pose>&, JointGraph<Pose>&);                             \
  template TeamAlignment<Pose> carried_alignment(const TeamEstimate<Pose>&, const JointGraph<Pose>&); \
  template std::optional<TeamEstimate<Pose>> extended(const TeamEstimate<Pose>&, JointGraph<Pose>);   \
  template std::vector<int> settled_components(const TeamEstimate<Pose>&, double);
RADIOSLAM_TEAM_CONTINUATION(SE2)
RADIOSLAM_TEAM_CONTINUATION(SE3)
#undef RADIOSLAM_TEAM_CONTINUATION

}  // namespace radioslam
