#include "radioslam/doctor/link_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "radioslam/doctor/window_team.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {
namespace {

constexpr double kLogAnywhere = 12.435;  // 200 m by 200 m and all headings

/// A window needs less of a search than a mission: its links are few and its trajectories short.
RadioAlignmentParams window_params() {
  RadioAlignmentParams params;
  params.grid.angle_steps = 36;
  params.grid.references = 2;
  params.grid.peaks = 2;
  params.beam.beam = 1;
  params.beam.tried_places = 4;
  params.beam.refined_places = 2;
  params.refinement.last_steps = 10;
  params.refinement.cost_tolerance = 0.05;
  return params;
}

/// Of the odometry's densities; the evidence of an alignment leaves it out.
template <class Pose>
double log_normaliser(const PoseGraph<Pose>& graph) {
  double sum = 0;
  for (const auto& step : graph.relative_poses)
    sum += Eigen::LLT<typename Pose::Jacobian>(step.information).matrixLLT().diagonal().array().log().sum();
  return sum;
}

template <class Pose>
double explained_links(const TeamHypothesis<Pose>& found) {
  double sum = std::accumulate(found.range_weight.begin(), found.range_weight.end(), 0.0);
  for (const auto& paths : found.path_weight) sum = std::accumulate(paths.begin(), paths.end(), sum);
  return sum;
}

template <class Pose>
bool has_links(const WindowTeam<Pose>& window) {
  return !window.team.graph.ranges.empty() || !window.team.bearings.empty();
}

/// No link explained: ranges of any length, angles of any direction.
template <class Pose>
LinkFit nothing_explained(const WindowTeam<Pose>& window) {
  LinkFit fit;
  fit.links = window.links;
  fit.log_evidence = window.log_density;
  for (const auto& range : window.team.graph.ranges)
    fit.log_evidence -= std::log(std::max(1.0, range.range_m));
  return fit;
}

template <class Pose>
LinkFit described(const WindowTeam<Pose>& window, const TeamHypothesis<Pose>& found) {
  if (!std::isfinite(found.log_evidence))
    return nothing_explained(window);  // the links leave a direction open
  LinkFit fit;
  fit.links = window.links;
  fit.log_evidence = window.log_density + found.log_evidence + log_normaliser(window.team.graph);
  fit.explained = explained_links(found);
  const auto T_frame_node = [&](std::size_t side) {
    const std::size_t first = window.team.segments[side].first_pose;
    return as_se3(found.poses[first] * window.team.graph.poses[first].inverse(), 0);
  };
  fit.T_i_j = T_frame_node(0).inverse() * T_frame_node(1);
  return fit;
}

template <class Pose>
LinkFit fitted(const TeamLinks& links, const LinkWindow& window) {
  static const RadioAlignmentParams params = window_params();
  const WindowTeam<Pose> built = window_team<Pose>(links, window);
  if (!has_links(built)) return nothing_explained(built);
  const RadioAlignment<Pose> alignment = align_by_radio(built.team, params);
  if (alignment.components.of_segment[0] != alignment.components.of_segment[1])
    return nothing_explained(built);
  return described(built, alignment.hypotheses.front());
}

template <class Pose>
LinkFit fitted_near(const TeamLinks& links, const LinkWindow& window, const StatedAlignment& stated) {
  static const RadioAlignmentParams params = window_params();
  WindowTeam<Pose> built = window_team<Pose>(links, window);
  if (!has_links(built)) return nothing_explained(built);
  PoseGraph<Pose>& graph = built.team.graph;
  move_segment(graph.poses, built.team.segments[1], pose_as<Pose>(stated.T_i_j));
  RelativePoseFactor<Pose> prior;
  prior.i = PoseId(0);
  prior.j = PoseId(built.team.segments[1].first_pose);
  prior.T_i_j = graph.poses[0].inverse() * graph.poses[prior.j.index()];
  auto diagonal = prior.information.diagonal();
  diagonal.setConstant(1 / (stated.sigma_m * stated.sigma_m));
  diagonal.template tail<Pose::kDof - Pose::kDim>().setConstant(1 / (stated.sigma_rad * stated.sigma_rad));
  graph.relative_poses.push_back(prior);
  LinkFit fit = described(built, refine_alignment(built.team, {{0, 0}, {}}, params));
  fit.log_evidence += kLogAnywhere - Pose::kDof * std::log(2 * std::numbers::pi) / 2;
  return fit;
}

}  // namespace

LinkFit fit_links(const TeamLinks& team, const LinkWindow& window) {
  return team.is_planar ? fitted<SE2>(team, window) : fitted<SE3>(team, window);
}

LinkFit fit_links_near(const TeamLinks& team, const LinkWindow& window, const StatedAlignment& stated) {
  return team.is_planar ? fitted_near<SE2>(team, window, stated) : fitted_near<SE3>(team, window, stated);
}

}  // namespace radioslam
