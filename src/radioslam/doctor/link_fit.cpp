#include "radioslam/doctor/link_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/team_graph.hpp"
#include "radioslam/radio/aoa/aoa_likelihood.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {
namespace {

/// A window of links as a team of two segments: the poses of both nodes at the links' times, their odometry
/// with its stated noise, and the links. The world is a segment of one pose, its points are lever arms of it.
template <class Pose>
struct WindowTeam {
  TeamGraph<Pose> team;  ///< segments of nodes i and j, each in its own frame
  /// log |d corrected / d recorded| of all ranges, and the log density of those without odometry at their
  /// time.
  double log_density = 0;
  std::size_t links = 0;     ///< of the window, unplaced ones included
  std::vector<bool> is_fix;  ///< per range
};

constexpr double kSigmaLevel_rad = 0.03;  // of odometry's roll and pitch
constexpr double kMinSpan_m = 1;

Stamp stamp_of(double t_s) { return Stamp::from_seconds(t_s); }

template <class Pose>
class WindowTeamBuilder {
 public:
  WindowTeamBuilder(const TeamLinks& team, const LinkWindow& window)
      : team_(team), nodes_{window.i, window.j} {
    result_.links = window.links.size();
    for (const std::size_t k : window.links)
      if (is_placed(team.links[k])) placed_.push_back(&team.links[k]);
  }

  WindowTeam<Pose> build(const LinkWindow& window) {
    add_segment(0);
    add_segment(1);
    for (const TrackLink* link : placed_) add(*link);
    double span_m = kMinSpan_m;
    for (const std::size_t k : window.links)
      if (team_.links[k].kind != TrackLink::Kind::kAngle) span_m = std::max(span_m, team_.links[k].range_m);
    for (const std::size_t k : window.links) {
      const TrackLink& link = team_.links[k];
      result_.log_density += link.log_density;
      if (link.kind != TrackLink::Kind::kAngle && !is_placed(link)) result_.log_density -= std::log(span_m);
    }
    return std::move(result_);
  }

 private:
  bool is_world(std::size_t node) const { return node == team_.world(); }
  bool is_placed(const TrackLink& link) const {
    return std::all_of(nodes_.begin(), nodes_.end(), [&](std::size_t node) {
      return is_world(node) || team_.tracks[node].at(link.t_s).has_value();
    });
  }

  void add_segment(std::size_t side) {
    const std::size_t node = nodes_[side];
    std::vector<double>& times = times_[side];
    for (const TrackLink* link : placed_) times.push_back(link->t_s);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    if (is_world(node) && !times.empty()) times.resize(1);
    PoseGraph<Pose>& graph = result_.team.graph;
    TrajectorySegment segment{std::to_string(node), graph.poses.size(), times.size(), {}};
    for (std::size_t n = 0; n < times.size(); ++n) {
      segment.stamps.push_back(stamp_of(times[n]));
      if (is_world(node)) {
        graph.poses.push_back(Pose());
        continue;
      }
      const auto row = *team_.tracks[node].at(times[n]);
      graph.poses.push_back(pose_as<Pose>(SE3(row.position_m, row.rotation)));
      if (n > 0) add_odometry(node, times[n - 1], times[n]);
    }
    if constexpr (Pose::kDim == 3) add_level(segment);
    result_.team.segments.push_back(std::move(segment));
  }

  void add_odometry(std::size_t node, double begin_s, double end_s) {
    PoseGraph<Pose>& graph = result_.team.graph;
    const OdometryEdge<Pose> edge = team_.tracks[node].template motion<Pose>(begin_s, end_s);
    RelativePoseFactor<Pose> factor;
    factor.i = PoseId(graph.poses.size() - 2);
    factor.j = PoseId(graph.poses.size() - 1);
    factor.T_i_j = edge.T_i_j;
    factor.information = inverse(edge.covariance);
    graph.relative_poses.push_back(factor);
  }

  void add_level(const TrajectorySegment& segment) {
    for (std::size_t n = 0; n < segment.pose_count; ++n) {
      PosePriorFactor<Pose> level;
      level.i = PoseId(segment.first_pose + n);
      level.prior = result_.team.graph.poses[level.i.index()];
      level.information.setZero();
      // Successive poses share their tilt: together they count as one observation.
      level.information.diagonal().template tail<3>().setConstant(
          1 / (kSigmaLevel_rad * kSigmaLevel_rad * static_cast<double>(segment.pose_count)));
      level.gravity_only = true;
      result_.team.graph.pose_priors.push_back(level);
    }
  }

  RangeEnd<Pose> end(const TrackEnd& end, double t_s) const {
    const std::size_t side = end.node == nodes_[0] ? 0 : 1;
    const auto& times = times_[side];
    const std::size_t n =
        is_world(end.node)
            ? 0
            : static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), t_s) - times.begin());
    RangeEnd<Pose> result;
    result.pose = PoseId(result_.team.segments[side].first_pose + n);
    result.lever_arm = end.point_m.template head<Pose::kDim>();
    return result;
  }

  void add(const TrackLink& link) {
    if (link.kind != TrackLink::Kind::kAngle) {
      RangeFactor<Pose> factor;
      factor.i = end(link.a, link.t_s);
      factor.j = end(link.b, link.t_s);
      factor.range_m = link.range_m;
      factor.sigma_m = link.sigma;
      result_.team.graph.ranges.push_back(factor);
      result_.is_fix.push_back(link.kind == TrackLink::Kind::kFix);
      return;
    }
    AmbiguousBearing<Pose> bearing;
    bearing.i = end(link.a, link.t_s).pose;
    bearing.j = end(link.b, link.t_s);
    for (const AoaPath& path : link.paths)
      bearing.paths.push_back({unit_vector(path).template head<Pose::kDim>(), path.sigma_rad, path.power_db,
                               !path.elevation_rad});
    result_.team.bearings.push_back(std::move(bearing));
  }

  const TeamLinks& team_;
  std::array<std::size_t, 2> nodes_;
  std::array<std::vector<double>, 2> times_;
  std::vector<const TrackLink*> placed_;
  WindowTeam<Pose> result_;
};

template <class Pose>
WindowTeam<Pose> window_team(const TeamLinks& team, const LinkWindow& window) {
  return WindowTeamBuilder<Pose>(team, window).build(window);
}

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
    sum += Cholesky<typename Pose::Jacobian>(step.information).factor().diagonal().array().log().sum();
  return sum;
}

template <class Pose>
double squared_error(const TeamHypothesis<Pose>& found, const RangeFactor<Pose>& range) {
  const auto place = [&](const RangeEnd<Pose>& end) {
    return (found.poses[end.pose.index()] * end.lever_arm).eval();
  };
  return std::pow(((place(range.j) - place(range.i)).norm() - range.range_m) / range.sigma_m, 2);
}

/// A fix of a wide sigma is explained where it agrees: its posterior is no larger than that of a false one.
template <class Pose>
double explained_links(const WindowTeam<Pose>& window, const TeamHypothesis<Pose>& found) {
  constexpr double kSquaredSigmas = 9;
  double sum = 0;
  for (std::size_t k = 0; k < found.range_weight.size(); ++k) {
    const bool agrees =
        window.is_fix[k] && squared_error(found, window.team.graph.ranges[k]) < kSquaredSigmas;
    sum += agrees ? 1 : found.range_weight[k];
  }
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
  fit.explained = explained_links(window, found);
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
