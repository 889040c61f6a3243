#include "radioslam/doctor/window_team.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/radio/aoa/aoa_likelihood.hpp"

namespace radioslam {
namespace {

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

}  // namespace

template <class Pose>
WindowTeam<Pose> window_team(const TeamLinks& team, const LinkWindow& window) {
  return WindowTeamBuilder<Pose>(team, window).build(window);
}

template WindowTeam<SE2> window_team(const TeamLinks&, const LinkWindow&);
template WindowTeam<SE3> window_team(const TeamLinks&, const LinkWindow&);

}  // namespace radioslam
