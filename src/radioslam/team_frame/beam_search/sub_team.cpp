#include "radioslam/team_frame/beam_search/sub_team.hpp"

#include <utility>

namespace radioslam {
namespace {

/// New ids of the poses that are kept.
template <class Pose>
class KeptPoses {
 public:
  explicit KeptPoses(std::size_t poses) : id_(poses) {}
  void set(std::size_t pose, PoseId id) { id_[pose] = id; }

  /// Gives the factor's ends their new ids; false if one is not kept.
  bool renumber(PoseId& pose) const {
    pose = id_[pose.index()];
    return pose.valid();
  }
  bool renumber(RangeEnd<Pose>& end) const { return end.pose.valid() && renumber(end.pose); }

  template <class Factor>
  void copy_pairs(const std::vector<Factor>& from, std::vector<Factor>& to) const {
    for (Factor factor : from)
      if (renumber(factor.i) && renumber(factor.j)) to.push_back(std::move(factor));
  }
  template <class Factor>
  void copy_single(const std::vector<Factor>& from, std::vector<Factor>& to) const {
    for (Factor factor : from)
      if (renumber(factor.i)) to.push_back(std::move(factor));
  }

 private:
  std::vector<PoseId> id_;
};

}  // namespace

template <class Pose>
SubTeam<Pose> sub_team(const TeamGraph<Pose>& whole, std::vector<std::size_t> segments) {
  SubTeam<Pose> part;
  KeptPoses<Pose> kept(whole.graph.poses.size());
  PoseGraph<Pose>& graph = part.team.graph;
  graph.chart = whole.graph.chart;
  for (const std::size_t p : segments) {
    TrajectorySegment segment = whole.segments[p];
    for (std::size_t k = 0; k < segment.pose_count; ++k) {
      kept.set(segment.first_pose + k, PoseId(graph.poses.size()));
      graph.poses.push_back(whole.graph.poses[segment.first_pose + k]);
    }
    segment.first_pose = graph.poses.size() - segment.pose_count;
    part.team.segments.push_back(std::move(segment));
  }
  graph.drifts = whole.graph.drifts;
  graph.drift_priors = whole.graph.drift_priors;
  graph.range_biases = whole.graph.range_biases;
  graph.range_bias_priors = whole.graph.range_bias_priors;
  kept.copy_pairs(whole.graph.relative_poses, graph.relative_poses);
  kept.copy_pairs(whole.graph.ranges, graph.ranges);
  kept.copy_pairs(whole.bearings, part.team.bearings);
  kept.copy_pairs(whole.graph.relative_points, graph.relative_points);
  kept.copy_single(whole.graph.positions, graph.positions);
  kept.copy_single(whole.graph.pose_priors, graph.pose_priors);
  part.segments = std::move(segments);
  return part;
}

template SubTeam<SE2> sub_team(const TeamGraph<SE2>&, std::vector<std::size_t>);
template SubTeam<SE3> sub_team(const TeamGraph<SE3>&, std::vector<std::size_t>);

}  // namespace radioslam
