#include "radioslam/closure/overlap/keyframe_skeleton.hpp"

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/factor_lists.hpp"
#include "radioslam/graph/pose_chart.hpp"
#include "radioslam/graph/pose_ids.hpp"

namespace radioslam {
namespace {

template <class Pose>
class Reduction {
 public:
  Reduction(const PoseGraph<Pose>& graph, const std::vector<ChainOfPoses>& chains)
      : graph_(graph), chains_(chains), division_(divide_into_segments(graph, chains)) {}

  Skeleton<Pose> run() {
    skeleton_.chains = std::move(division_.chains);
    renumber_poses();
    copy_factors();
    for (std::size_t c = 0; c < chains_.size(); ++c)
      for (const ChainSegment& segment : skeleton_.chains[c].segments)
        if (segment.first < segment.last) add_segment(c, segment);
    skeleton_.component = connected_components(graph_).of_pose;
    return std::move(skeleton_);
  }

 private:
  void renumber_poses() {
    skeleton_.of_pose.resize(division_.is_end.size());
    auto& reduced = skeleton_.graph;
    reduced.chart = graph_.chart;
    reduced.points = graph_.points;
    reduced.drifts = graph_.drifts;
    reduced.range_biases = graph_.range_biases;
    for (std::size_t i = 0; i < division_.is_end.size(); ++i) {
      if (!division_.is_end[i]) continue;
      skeleton_.of_pose[i] = PoseId(reduced.poses.size());
      reduced.poses.push_back(graph_.poses[i]);
      reduced.pose_fixed.push_back(division_.gauge.held[i]);
    }
  }

  void copy_factors() {
    auto& reduced = skeleton_.graph;
    for (std::size_t f = 0; f < division_.is_step.size(); ++f)
      if (!division_.is_step[f]) reduced.relative_poses.push_back(graph_.relative_poses[f]);
    reduced.ranges = graph_.ranges;
    reduced.bearings = graph_.bearings;
    reduced.relative_points = graph_.relative_points;
    reduced.positions = graph_.positions;
    reduced.pose_priors = graph_.pose_priors;
    reduced.drift_priors = graph_.drift_priors;
    reduced.range_bias_priors = graph_.range_bias_priors;
    for_each_pose_id(reduced, [&](PoseId& id) { id = skeleton_.of_pose[id.index()]; });
  }

  const Pose& pose(std::size_t c, std::size_t k) const { return graph_.poses[chains_[c].poses[k].index()]; }

  /// Adds a factor with zero residual that reproduces the segment's normal equations.
  void add_segment(std::size_t c, const ChainSegment& segment) {
    SegmentSums<Pose> sums;
    const Pose T_c1_w = pose(c, segment.first).inverse();
    for (std::size_t k = segment.first; k < segment.last; ++k)
      sums.add(*skeleton_.chains[c].steps[k], T_c1_w * pose(c, k + 1));
    const Pose T_c1_c2 = T_c1_w * pose(c, segment.last);
    const typename Pose::Jacobian to_c2 = T_c1_c2.inverse().adjoint();
    const typename Pose::Jacobian chart = chart_derivative(graph_.chart, Pose());
    const typename Pose::Jacobian to_chart = chart * to_c2;
    const typename Pose::Jacobian covariance = congruence(to_chart, sums.covariance());
    RelativePoseFactor<Pose> factor;
    factor.i = skeleton_.of_pose[chains_[c].poses[segment.first].index()];
    factor.j = skeleton_.of_pose[chains_[c].poses[segment.last].index()];
    factor.T_i_j = T_c1_c2;
    factor.information = Cholesky<typename Pose::Jacobian>(covariance).inverse();
    factor.drift = segment.drift;
    factor.drift_jacobian = to_chart * sums.drift_effect();
    skeleton_.graph.relative_poses.push_back(factor);
  }

  const PoseGraph<Pose>& graph_;
  const std::vector<ChainOfPoses>& chains_;
  ChainSegments<Pose> division_;
  Skeleton<Pose> skeleton_;
};

}  // namespace

template <class Pose>
Skeleton<Pose> reduce_to_skeleton(const PoseGraph<Pose>& graph, const std::vector<ChainOfPoses>& chains) {
  return Reduction<Pose>(graph, chains).run();
}

template Skeleton<SE2> reduce_to_skeleton(const PoseGraph<SE2>&, const std::vector<ChainOfPoses>&);
template Skeleton<SE3> reduce_to_skeleton(const PoseGraph<SE3>&, const std::vector<ChainOfPoses>&);

}  // namespace radioslam
