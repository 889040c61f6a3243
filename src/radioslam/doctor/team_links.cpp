#include "radioslam/doctor/team_links.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "radioslam/radio/aoa/aoa_likelihood.hpp"

namespace radioslam {
namespace {

constexpr double kRowDistance_m = 0.5;
constexpr double kRowTime_s = 1;
constexpr double kRowAngle_rad = 0.1;
constexpr std::size_t kMaxWindowLinks = 50;
constexpr std::size_t kMinWindowLinks = 12;
constexpr double kWindowPath_m = 150, kLongWindowPath_m = 500;  // wanted
constexpr double kMaxWindowPath_m = 1000;
constexpr double kMinWindowPath_m = 6;  // shorter ones tell nothing

using Pair = std::pair<std::size_t, std::size_t>;

std::map<Pair, std::vector<std::size_t>> links_of_pairs(const TeamLinks& team) {
  std::map<Pair, std::vector<std::size_t>> pairs;
  const auto is_placed = [&](const TrackEnd& end, double t_s) {
    return end.node == team.world() || team.tracks[end.node].at(t_s).has_value();
  };
  for (std::size_t k = 0; k < team.links.size(); ++k)
    if (is_placed(team.links[k].a, team.links[k].t_s) && is_placed(team.links[k].b, team.links[k].t_s))
      pairs[std::minmax(team.links[k].a.node, team.links[k].b.node)].push_back(k);
  for (auto& [pair, links] : pairs)
    std::stable_sort(links.begin(), links.end(),
                     [&](auto x, auto y) { return team.links[x].t_s < team.links[y].t_s; });
  return pairs;
}

/// Path of both nodes between two times; those of the world do not move.
double path_between(const TeamLinks& team, const Pair& pair, double begin_s, double end_s) {
  double path_m = 0;
  for (const std::size_t node : {pair.first, pair.second}) {
    if (node == team.world()) continue;
    const auto begin = team.tracks[node].at(begin_s), end = team.tracks[node].at(end_s);
    if (begin && end) path_m += end->path_m - begin->path_m;
  }
  return path_m;
}

/// At most `kMaxWindowLinks` of them. The strides' phases differ, since kinds of links follow each other
/// regularly.
std::vector<std::size_t> thinned(const std::vector<std::size_t>& links, std::size_t begin, std::size_t end) {
  const std::size_t count = std::min(end - begin, kMaxWindowLinks), stride = (end - begin) / count;
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < count; ++k)
    result.push_back(links[begin + k * (end - begin) / count + k % stride]);
  return result;
}

/// Cuts the links of a pair into windows of about this path that follow each other.
std::vector<LinkWindow> windows_of(const TeamLinks& team, const Pair& pair, double wanted_m,
                                   const std::vector<std::size_t>& links) {
  std::vector<LinkWindow> windows;
  std::size_t begin = 0;
  for (std::size_t end = 1; end <= links.size(); ++end) {
    const double t0 = team.links[links[begin]].t_s;
    const double path_m =
        end < links.size() ? path_between(team, pair, t0, team.links[links[end]].t_s) : kMaxWindowPath_m + 1;
    const bool is_long = path_m > wanted_m && end - begin >= 2 * kMinWindowLinks;
    if (!is_long && path_m <= kMaxWindowPath_m) continue;
    const double used_m = path_between(team, pair, t0, team.links[links[end - 1]].t_s);
    if (end - begin >= kMinWindowLinks && used_m >= kMinWindowPath_m)
      windows.push_back({pair.first, pair.second, thinned(links, begin, end), used_m});
    begin = end;
  }
  return windows;
}

void add_ranges(const Mission& mission, TeamLinks& team, const auto& end_of) {
  for (const RangeMeasurement& range : mission.ranges) {
    const auto a = end_of(range.i), b = end_of(range.j);
    if (a && b)
      team.links.push_back(
          {TrackLink::Kind::kRange, range.stamp.seconds(), *a, *b, range.range_m, range.sigma_m, {}});
  }
}

void add_angles(const Mission& mission, TeamLinks& team, const auto& end_of) {
  for (const AoaMeasurement& angle : mission.aoa_measurements) {
    const auto b = end_of(angle.transmitter);
    if (!b || team.tracks[angle.receiver.index()].empty()) continue;
    const TrackEnd a{angle.receiver.index(), Eigen::Vector3d::Zero()};
    const double no_range = std::numeric_limits<double>::quiet_NaN(),
                 sigma_rad = angle.paths.front().sigma_rad;
    const auto at = team.tracks[angle.receiver.index()].at(angle.stamp.seconds());
    const auto paths =
        team.is_planar && at ? levelled(angle, SE3(at->position_m, at->rotation)).paths : angle.paths;
    team.links.push_back({TrackLink::Kind::kAngle, angle.stamp.seconds(), a, *b, no_range, sigma_rad, paths});
  }
}

void add_fixes(const Mission& mission, TeamLinks& team) {
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    for (const PositionFix& fix : mission.robots[r].fixes)
      team.links.push_back({TrackLink::Kind::kFix,
                            fix.stamp.seconds(),
                            {r, mission.robots[r].fix_lever_m},
                            {team.world(), fix.position_m},
                            0,
                            fix.sigma_m,
                            {}});
}

/// Moves the world's frame to the middle of its points: numbers stay small where coordinates are those of a
/// map.
void centre_world(TeamLinks& team) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  const auto for_points = [&](const auto& visit) {
    for (TrackLink& link : team.links)
      for (TrackEnd* end : {&link.a, &link.b})
        if (end->node == team.world()) visit(end->point_m);
  };
  for_points([&](const Eigen::Vector3d& point) { sum += point, count += 1; });
  if (count == 0) return;
  team.world_origin_m = sum / count;
  for_points([&](Eigen::Vector3d& point) { point -= team.world_origin_m; });
}

}  // namespace

Track::Track(const Robot& robot) : noise_(robot.odometry_noise) {
  const Trajectory<SE3>& odometry = robot.odometry;
  double path_m = 0;
  const StampedPose<SE3>* last = nullptr;
  for (std::size_t k = 0; k < odometry.size(); ++k) {
    const auto& row = odometry[k];
    if (last) {
      const double step_m = (row.pose.translation() - last->pose.translation()).norm();
      const double turn_rad = row.pose.rotation().angularDistance(last->pose.rotation());
      const bool is_end = k + 1 == odometry.size();
      if (!is_end && step_m < kRowDistance_m && turn_rad < kRowAngle_rad &&
          seconds_between(last->stamp, row.stamp) < kRowTime_s)
        continue;
      path_m += step_m;
    }
    rows_.push_back({row.stamp.seconds(), row.pose.translation(), row.pose.rotation(), path_m});
    last = &row;
  }
}

std::optional<Track::Row> Track::at(double t_s) const {
  t_s -= shift_s_;
  if (rows_.empty() || t_s < rows_.front().t_s || t_s > rows_.back().t_s) return std::nullopt;
  if (rows_.size() == 1) return rows_.front();
  auto after =
      std::upper_bound(rows_.begin(), rows_.end(), t_s, [](double t, const Row& r) { return t < r.t_s; });
  if (after == rows_.end()) --after;
  const Row &x = *(after - 1), &y = *after;
  const double f = (t_s - x.t_s) / (y.t_s - x.t_s);
  return Row{t_s + shift_s_, x.position_m + f * (y.position_m - x.position_m),
             x.rotation.slerp(f, y.rotation), x.path_m + f * (y.path_m - x.path_m)};
}

void Track::mirror() {
  for (Row& row : rows_) {
    row.position_m.y() *= -1;
    // The rotation seen in a mirror: S R S with S = diag(1, -1, 1).
    row.rotation =
        Eigen::Quaterniond(row.rotation.w(), -row.rotation.x(), row.rotation.y(), -row.rotation.z());
  }
}

template <class Pose>
OdometryEdge<Pose> Track::motion(double begin_s, double end_s) const {
  const auto sample = [](double t_s, const Row& row) {
    return StampedPose<SE3>{Stamp::from_seconds(t_s), SE3(row.position_m, row.rotation)};
  };
  const double begin = begin_s - shift_s_, end = end_s - shift_s_;  // as recorded
  OdometryEdge<Pose> edge;
  StampedPose<SE3> last = sample(begin, *at(begin_s));
  auto row =
      std::upper_bound(rows_.begin(), rows_.end(), begin, [](double t, const Row& r) { return t < r.t_s; });
  for (; row != rows_.end() && row->t_s < end; ++row) {
    const StampedPose<SE3> next = sample(row->t_s, *row);
    append_sample(edge, last, next, noise_);
    last = next;
  }
  append_sample(edge, last, sample(end, *at(end_s)), noise_);
  edge.covariance.diagonal() += min_edge_variance<Pose>();
  return edge;
}
template OdometryEdge<SE2> Track::motion<SE2>(double, double) const;
template OdometryEdge<SE3> Track::motion<SE3>(double, double) const;

void Track::scale(double factor) {
  for (Row& row : rows_) row.position_m *= factor, row.path_m *= factor;
}

TeamLinks team_links(const Mission& mission) {
  TeamLinks team;
  team.is_planar = mission.dimension == 2;
  for (const Robot& robot : mission.robots) team.tracks.emplace_back(robot);
  const auto end_of = [&](const LinkEnd& end) -> std::optional<TrackEnd> {
    if (end.robot.valid()) {
      if (team.tracks[end.robot.index()].empty()) return std::nullopt;
      return TrackEnd{end.robot.index(), end.lever_arm_m};
    }
    const auto& position = mission.anchors[end.anchor.index()].position_m;
    if (!position) return std::nullopt;
    return TrackEnd{team.world(), *position};
  };
  add_ranges(mission, team, end_of);
  add_angles(mission, team, end_of);
  add_fixes(mission, team);
  centre_world(team);
  return team;
}

std::vector<LinkWindow> link_windows(const TeamLinks& team, std::size_t per_pair) {
  std::vector<LinkWindow> result;
  for (const auto& [pair, links] : links_of_pairs(team))
    for (const double wanted_m : {kWindowPath_m, kLongWindowPath_m}) {
      std::vector<LinkWindow> windows = windows_of(team, pair, wanted_m, links);
      const std::size_t count = std::min(wanted_m == kWindowPath_m ? per_pair - 1 : 1, windows.size());
      for (std::size_t k = 0; k < count; ++k)
        result.push_back(std::move(windows[k * windows.size() / count]));
    }
  return result;
}

void keep_links_of(std::vector<LinkWindow>& windows, TeamLinks& team) {
  std::vector<TrackLink> kept;
  for (LinkWindow& window : windows)
    for (std::size_t& k : window.links) {
      kept.push_back(team.links[k]);
      k = kept.size() - 1;
    }
  team.links = std::move(kept);
}

}  // namespace radioslam
