#include "radioslam/joint/position_fixes/component_placement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/position_fixes/heading_of_fixes.hpp"

namespace radioslam {
namespace {

Eigen::Matrix2Xd columns(const std::vector<FixAlongPath>& fixes, Eigen::Vector3d FixAlongPath::*of) {
  Eigen::Matrix2Xd result(2, static_cast<Eigen::Index>(fixes.size()));
  for (std::size_t k = 0; k < fixes.size(); ++k)
    result.col(static_cast<Eigen::Index>(k)) = (fixes[k].*of).head<2>();
  return result;
}

/// Inverse variances of the fixes that agree with the transform, 0 for the others.
Eigen::VectorXd weights_at(const std::vector<FixAlongPath>& fixes, const SE3& T_fixes_component,
                           double gate) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fixes.size()));
  for (std::size_t k = 0; k < fixes.size(); ++k) {
    const double variance = fixes[k].sigma_m * fixes[k].sigma_m;
    const Eigen::Vector3d off = T_fixes_component * fixes[k].by_odometry_m - fixes[k].position_m;
    if (off.head<2>().squaredNorm() <= gate * variance) weights[static_cast<Eigen::Index>(k)] = 1 / variance;
  }
  return weights;
}

/// T_common_component by the fixes, where they determine it.
std::optional<SE3> transform_by_fixes(const std::vector<FixAlongPath>& fixes, const FixParams& params) {
  if (fixes.size() < static_cast<std::size_t>(params.min_fixes)) return std::nullopt;
  const auto found = align_by_fixes(fixes, params.alignment);
  if (!found) return std::nullopt;
  const double gate = chi_squared_quantile(params.gate_probability, 2);
  const Eigen::VectorXd weights = weights_at(fixes, found->T_fixes_start, gate);
  const double agreeing = static_cast<double>((weights.array() > 0).count());
  if (agreeing < params.min_fixes || agreeing < params.min_inlier_ratio * static_cast<double>(fixes.size()))
    return std::nullopt;
  const Eigen::Matrix2Xd source = columns(fixes, &FixAlongPath::by_odometry_m);
  if (heading_information(source, weights) < 1 / (params.max_sigma_yaw_rad * params.max_sigma_yaw_rad))
    return std::nullopt;
  return lift(align_points(source, columns(fixes, &FixAlongPath::position_m), weights),
              found->T_fixes_start.translation().z());
}

/// Fixes of a component's robots that are not used yet, with the positions that the graph gives them.
template <class Pose>
std::vector<FixAlongPath> fixes_of_component(const JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes,
                                             const TeamAlignment<Pose>& alignment, int component) {
  std::vector<FixAlongPath> result;
  for (std::size_t r = 0; r < fixes.size(); ++r) {
    const bool is_unused = fixes[r].role == FixUse::kTooFew || fixes[r].role == FixUse::kNoBaseline;
    if (alignment.component[r] != component || !alignment.placed[r] || !is_unused) continue;
    const double sigma_layout_m = alignment.sigma_layout_m.empty() ? 0 : alignment.sigma_layout_m[r];
    for (const auto& factor : fixes[r].factors) {
      FixAlongPath fix;
      fix.by_odometry_m.template head<Pose::kDim>() = position(joint.team.graph, factor.i);
      fix.position_m.template head<Pose::kDim>() = factor.position;
      fix.sigma_m = std::hypot(1 / std::sqrt(factor.information(0, 0)), sigma_layout_m);
      result.push_back(fix);
    }
  }
  return result;
}

/// Left-multiplies the component's poses, and what is expected of them, by T.
template <class Pose>
void move_component(JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment, int component,
                    const Pose& T) {
  auto& graph = joint.team.graph;
  for (std::size_t s = 0; s < joint.team.segments.size(); ++s) {
    if (alignment.of_segment[s] != component) continue;
    const TrajectorySegment& segment = joint.team.segments[s];
    move_segment(graph.poses, segment, T);
    for (auto& prior : graph.pose_priors)
      if (prior.i.index() - segment.first_pose < segment.pose_count) prior.prior = T * prior.prior;
  }
}

}  // namespace

template <class Pose>
void place_components_by_fixes(JointGraph<Pose>& joint, const TeamFixes<Pose>& fixes, const FixParams& params,
                               TeamAlignment<Pose>& alignment) {
  if (fixes.empty() || !alignment.alternatives.empty()) return;
  for (std::size_t c = 0; c < alignment.absolute.size(); ++c) {
    const int component = static_cast<int>(c);
    if (alignment.absolute[c]) continue;
    const auto T = transform_by_fixes(fixes_of_component(joint, fixes, alignment, component), params);
    if (!T) continue;
    move_component(joint, alignment, component, pose_as<Pose>(*T));
    alignment.absolute[c] = true;
    for (std::size_t r = 0; r < alignment.component.size(); ++r)
      if (alignment.component[r] == component) alignment.in_common_frame[r] = true;
  }
}

template void place_components_by_fixes(JointGraph<SE2>&, const TeamFixes<SE2>&, const FixParams&,
                                        TeamAlignment<SE2>&);
template void place_components_by_fixes(JointGraph<SE3>&, const TeamFixes<SE3>&, const FixParams&,
                                        TeamAlignment<SE3>&);

}  // namespace radioslam
