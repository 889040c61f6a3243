#include "radioslam/team_frame/pose_proposals.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/team_frame/level_view.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxScored = 200;                // more do not improve the ranking
constexpr double kUniformSigma = 0.28867513459481287;  // of a uniform density of unit width

/// Measurement between the component and the unit.
template <class Pose>
struct CrossLink {
  bool is_range = true;
  std::size_t index = 0;  ///< in the team's ranges or bearings
  RangeEnd<Pose> placed, free;
  bool received_by_placed = true;
};

template <class Pose>
class CrossLinks {
 public:
  CrossLinks(const TeamGraph<Pose>& team, const TeamComponents& components, int component,
             const UnplacedNode& unit)
      : segment_of_(segment_of_poses(team)), components_(components), component_(component), unit_(unit) {
    for (std::size_t k = 0; k < team.graph.ranges.size(); ++k)
      add(true, k, team.graph.ranges[k].i, team.graph.ranges[k].j);
    for (std::size_t k = 0; k < team.bearings.size(); ++k)
      add(false, k, {team.bearings[k].i, {}, team.bearings[k].T_i_receiver.translation()},
          team.bearings[k].j);
  }
  const std::vector<CrossLink<Pose>>& links() const { return links_; }

 private:
  void add(bool is_range, std::size_t index, const RangeEnd<Pose>& i, const RangeEnd<Pose>& j) {
    if (is_placed(i) && is_unit(j)) links_.push_back({is_range, index, i, j, true});
    if (is_placed(j) && is_unit(i)) links_.push_back({is_range, index, j, i, false});
  }
  bool is_unit(const RangeEnd<Pose>& end) const {
    if (end.pose.valid()) return unit_.is_segment && segment_of_[end.pose.index()] == unit_.index;
    return !unit_.is_segment && end.point.index() == unit_.index;
  }
  bool is_placed(const RangeEnd<Pose>& end) const {
    const int of = end.pose.valid() ? components_.of_segment[segment_of_[end.pose.index()]]
                                    : components_.of_point[end.point.index()];
    return of == component_ && !is_unit(end);
  }

  std::vector<std::size_t> segment_of_;
  const TeamComponents& components_;
  int component_;
  const UnplacedNode& unit_;
  std::vector<CrossLink<Pose>> links_;
};

Eigen::Matrix3d plane_covariance(const SE2& T_ref_end, const Eigen::Matrix3d& covariance, const SE2& /*pose*/,
                                 const SE2& /*reference*/) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r.topLeftCorner<2, 2>() = T_ref_end.rotation_matrix();
  return r * covariance * r.transpose();
}

Eigen::Matrix3d plane_covariance(const SE2& /*T_ref_end*/, const Eigen::Matrix<double, 6, 6>& covariance,
                                 const SE3& pose, const SE3& reference) {
  const Eigen::Matrix3d to_reference =
      Eigen::AngleAxisd(-reference.yaw(), Eigen::Vector3d::UnitZ()) * pose.rotation_matrix();
  Eigen::Matrix<double, 3, 6> j = Eigen::Matrix<double, 3, 6>::Zero();
  j.topLeftCorner<2, 3>() = to_reference.topRows<2>();
  j.bottomRightCorner<1, 3>() = to_reference.row(2);
  return j * covariance * j.transpose();
}

double height(const Eigen::Vector2d& /*point*/) { return 0; }
double height(const Eigen::Vector3d& point) { return point.z(); }

std::optional<double> level_elevation(const SE2& /*receiver*/, const AmbiguousBearing<SE2>& /*bearing*/,
                                      std::size_t /*p*/) {
  return std::nullopt;
}
std::optional<double> level_elevation(const SE3& receiver, const AmbiguousBearing<SE3>& bearing,
                                      std::size_t p) {
  if (bearing.paths[p].azimuth_only) return std::nullopt;
  return std::asin(std::clamp((receiver.rotation() * direction_in_body(bearing, p)).z(), -1.0, 1.0));
}

/// Builds the grid problem of one reference link.
template <class Pose>
class Reference {
 public:
  Reference(const TeamGraph<Pose>& team, const PoseGraph<Pose>& weighted, const CrossLink<Pose>& link,
            const MixtureParams& mixture, const GridParams& params)
      : team_(team), values_(weighted), link_(link), mixture_(mixture), params_(params) {
    PoseGraph<Pose> held = weighted;
    held.pose_fixed.assign(held.poses.size(), false);
    held.pose_priors.clear();
    if (link.placed.pose.valid()) held.pose_fixed[link.placed.pose.index()] = true;
    if (link.free.pose.valid()) held.pose_fixed[link.free.pose.index()] = true;
    marginals_ = Marginals<Pose>::compute(held);
  }

  bool usable() const { return marginals_.has_value(); }

  /// With elevations, the problem is for heights alone: over the grid the height is not known.
  GridProblem problem(const std::vector<CrossLink<Pose>>& links, bool with_elevation) const {
    GridProblem problem;
    problem.mixture = mixture_;
    for (const auto& range : team_.graph.ranges) problem.span_m = std::max(problem.span_m, range.range_m);
    problem.height_m = height(position(values_, link_.free)) - height(position(values_, link_.placed));
    if (Pose::kDim == 3 && link_.free.pose.valid()) problem.sigma_height_m = params_.sigma_height_m;
    problem.distances = distances(problem.height_m);
    problem.heading = known_heading();
    for (const auto& link : links) {
      const GridEnd placed = end(link.placed, link_.placed), free = end(link.free, link_.free);
      if (link.is_range) {
        const auto& range = team_.graph.ranges[link.index];
        problem.ranges.push_back({placed, free, range.range_m, range.sigma_m});
      } else {
        problem.bearings.push_back(bearing(link, placed, free, with_elevation));
      }
    }
    return problem;
  }

  SE2 place(const GridCell& cell) const {
    const Eigen::Vector2d offset =
        cell.distance_m * Eigen::Vector2d(std::cos(cell.phi_rad), std::sin(cell.phi_rad));
    return frame(link_.placed) * SE2(offset, cell.theta_rad) * frame(link_.free).inverse();
  }

 private:
  /// Levelled frame at an end; at a point it has the component's orientation.
  SE2 frame(const RangeEnd<Pose>& end) const {
    const auto p = position(values_, end);
    const double yaw = end.pose.valid() ? seen_from_above(values_.poses[end.pose.index()]).angle() : 0;
    return {p.template head<2>(), yaw};
  }

  GridEnd end(const RangeEnd<Pose>& end, const RangeEnd<Pose>& reference) const {
    const SE2 T_ref_end = frame(reference).inverse() * frame(end);
    GridEnd result{T_ref_end.translation(), T_ref_end.angle(), Eigen::Matrix3d::Zero(), 0};
    result.height_m = height(position(values_, end)) - height(position(values_, reference));
    if (!end.pose.valid()) {
      const bool itself = !reference.pose.valid() && reference.point == end.point;
      if (!itself) result.covariance.template topLeftCorner<2, 2>() = point_covariance(end.point);
      return result;
    }
    const Pose& pose = values_.poses[end.pose.index()];
    const Pose reference_pose = reference.pose.valid() ? values_.poses[reference.pose.index()] : Pose();
    result.covariance = plane_covariance(T_ref_end, marginals_->pose(end.pose), pose, reference_pose);
    return result;
  }

  Eigen::Matrix2d point_covariance(PointId point) const {
    const auto covariance = marginals_->point(point);
    return covariance.allFinite() ? Eigen::Matrix2d(covariance.template topLeftCorner<2, 2>())
                                  : Eigen::Matrix2d(Eigen::Matrix2d::Identity() * mixture_.max_range_m);
  }

  GridBearing bearing(const CrossLink<Pose>& link, const GridEnd& placed, const GridEnd& free,
                      bool with_elevation) const {
    const auto& measured = team_.bearings[link.index];
    const Pose& receiver = values_.poses[measured.i.index()];
    GridBearing result{placed, free, link.received_by_placed, {}, {}, path_priors(measured, mixture_), {}};
    for (std::size_t p = 0; p < measured.paths.size(); ++p) {
      result.azimuth_rad.push_back(level_azimuth(receiver, direction_in_body(measured, p)));
      result.sigma_rad.push_back(measured.paths[p].sigma_rad);
      if (with_elevation) result.elevation_rad.push_back(level_elevation(receiver, measured, p));
    }
    return result;
  }

  std::vector<DistanceCell> distances(double height_m) const {
    if (link_.is_range) {
      const auto& range = team_.graph.ranges[link_.index];
      const double flat2 = range.range_m * range.range_m - height_m * height_m;
      return {{std::sqrt(std::max(flat2, 0.0)), range.sigma_m}};
    }
    std::vector<DistanceCell> cells;
    for (double d = 1; d < mixture_.max_range_m * params_.distance_ratio; d *= params_.distance_ratio)
      cells.push_back({d, kUniformSigma * d * std::log(params_.distance_ratio)});
    return cells;
  }

  /// theta and its standard deviation, if both sides have an absolute heading.
  std::optional<std::pair<double, double>> known_heading() const {
    if (!link_.free.pose.valid()) return std::pair(-frame(link_.placed).angle(), 0.0);
    if (!link_.placed.pose.valid()) return std::nullopt;
    const auto segment_of = segment_of_poses(team_);
    const double a = team_.segments[segment_of[link_.placed.pose.index()]].sigma_heading_rad;
    const double b = team_.segments[segment_of[link_.free.pose.index()]].sigma_heading_rad;
    if (a <= 0 || b <= 0) return std::nullopt;
    return std::pair(wrap_angle(frame(link_.free).angle() - frame(link_.placed).angle()), std::hypot(a, b));
  }

  const TeamGraph<Pose>& team_;
  const PoseGraph<Pose>& values_;
  const CrossLink<Pose>& link_;
  const MixtureParams& mixture_;
  const GridParams& params_;
  std::optional<Marginals<Pose>> marginals_;
};

/// At most `count` items, evenly spread.
template <class T>
std::vector<T> spread(const std::vector<T>& items, std::size_t count) {
  if (items.size() <= count) return items;
  std::vector<T> chosen;
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(items[(2 * k + 1) * items.size() / (2 * count)]);
  return chosen;
}

/// Reference links: ranges if there are any, since they fix the distance.
template <class Pose>
std::vector<CrossLink<Pose>> references(const std::vector<CrossLink<Pose>>& links, std::size_t count) {
  std::vector<CrossLink<Pose>> ranges;
  std::copy_if(links.begin(), links.end(), std::back_inserter(ranges),
               [](const auto& l) { return l.is_range; });
  return spread(ranges.empty() ? links : ranges, count);
}

/// Maps variances from the links' order to the team's lists.
template <class Pose>
VarianceInflation over_team(const TeamGraph<Pose>& team, const std::vector<CrossLink<Pose>>& links,
                            const VarianceInflation& own) {
  VarianceInflation all{std::vector<double>(team.graph.ranges.size(), 0),
                        std::vector<double>(team.bearings.size(), 0)};
  std::size_t range = 0, bearing = 0;
  for (const auto& link : links) {
    if (link.is_range)
      all.ranges_m2[link.index] = own.ranges_m2[range++];
    else
      all.bearings_rad2[link.index] = own.bearings_rad2[bearing++];
  }
  return all;
}

/// Interleaves the lists by rank, since scores of different references are not comparable.
std::vector<PoseProposal> in_turn(std::vector<std::vector<PoseProposal>> lists) {
  std::vector<PoseProposal> result;
  std::size_t longest = 0;
  for (const auto& list : lists) longest = std::max(longest, list.size());
  for (std::size_t k = 0; k < longest; ++k)
    for (auto& list : lists)
      if (k < list.size()) result.push_back(std::move(list[k]));
  return result;
}

}  // namespace

template <class Pose>
std::size_t count_links(const TeamGraph<Pose>& team, const TeamComponents& components, int component,
                        const UnplacedNode& unit) {
  return CrossLinks<Pose>(team, components, component, unit).links().size();
}

template <class Pose>
std::vector<PoseProposal> propose_poses(const TeamGraph<Pose>& team, const TeamComponents& components,
                                        int component, const UnplacedNode& unit,
                                        const PoseGraph<Pose>& weighted, const MixtureParams& mixture,
                                        const GridParams& params) {
  const CrossLinks<Pose> cross(team, components, component, unit);
  const auto scored = spread(cross.links(), kMaxScored);
  std::vector<std::vector<PoseProposal>> per_reference;
  for (const auto& link : references(cross.links(), static_cast<std::size_t>(params.references))) {
    const Reference<Pose> reference(team, weighted, link, mixture, params);
    if (!reference.usable()) continue;
    const GridProblem whole = reference.problem(cross.links(), true);
    std::vector<PoseProposal>& places = per_reference.emplace_back();
    for (const GridCell& cell : best_cells(reference.problem(scored, false), params))
      for (const GridCell& level : at_best_heights(whole, cell, params))
        places.push_back({reference.place(level), level.rise_m, level.score,
                          over_team(team, cross.links(), propagated_variances(whole, level, params))});
  }
  return in_turn(std::move(per_reference));
}

#define RADIOSLAM_PLACES(Pose)                                                                               \
  template std::size_t count_links(const TeamGraph<Pose>&, const TeamComponents&, int, const UnplacedNode&); \
  template std::vector<PoseProposal> propose_poses(const TeamGraph<Pose>&, const TeamComponents&, int,       \
                                                   const UnplacedNode&, const PoseGraph<Pose>&,              \
                                                   const MixtureParams&, const GridParams&);
RADIOSLAM_PLACES(SE2)
RADIOSLAM_PLACES(SE3)
#undef RADIOSLAM_PLACES

}  // namespace radioslam
