#include "radioslam/rendezvous/robot_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/initial_values.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/normal_equations.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {
namespace {

constexpr double kRightWeight = 0.5;  ///< a relative pose of less is taken for wrong
constexpr double kSmallestWeight = 1e-9;
constexpr double kCostTolerance = 1e-7;
constexpr double kMaxLogOdds = 50;
constexpr double kUnknownVariance = 1e12;

SE2::Jacobian inverse_of(const SE2::Jacobian& covariance) {
  return Cholesky<SE2::Jacobian>(covariance).inverse();
}

/// Of a pose at the graph's values; as good as unknown where it cannot be computed. One block of columns is
/// cheaper than what Marginals prepares for all poses.
SE2::Jacobian covariance_in(const PoseGraph2& graph, NormalEquations<SE2>& equations, PoseId pose) {
  const std::int32_t block = equations.blocks().of(variable(pose));
  if (block < 0) return SE2::Jacobian::Zero();
  equations.linearise(graph);
  SE2::Jacobian covariance = kUnknownVariance * SE2::Jacobian::Identity();
  if (equations.factorize(0) == Factorization::kDone) {
    const auto column = static_cast<std::size_t>(block);
    const auto row = static_cast<Eigen::Index>(equations.matrix().offset(column));
    covariance = equations.cholesky().inverse_columns(column).middleRows(row, SE2::kDof);
  } else if (const auto marginals = Marginals<SE2>::compute(graph)) {
    covariance = marginals->pose(pose);
  }
  return covariance.allFinite() ? covariance : kUnknownVariance * SE2::Jacobian::Identity();
}

/// Odometry from one keyframe to a later one.
UncertainPose<SE2> way_between(const ReadLog& log, std::uint32_t from, std::uint32_t to) {
  UncertainPose<SE2> way = log.steps()[from + 1];
  for (std::size_t k = std::size_t{from} + 2; k <= to; ++k) way = way * log.steps()[k];
  return way;
}

}  // namespace

void RobotEstimate::Contact::add(std::size_t at, const RelativePoseFactor<SE2>& seen) {
  if (at > node || !information) {
    node = at;
    information = SE2::Jacobian::Zero();
  }
  if (at == node) *information += seen.weight * seen.information;
}

SE2::Jacobian RobotEstimate::Contact::covariance() const {
  return information ? inverse_of(*information) : SE2::Jacobian::Zero();
}

std::optional<std::size_t> RobotEstimate::Part::place_of(std::uint32_t keyframe) const {
  const auto at = std::lower_bound(keyframes.begin(), keyframes.end(), keyframe);
  if (at == keyframes.end() || *at != keyframe) return std::nullopt;
  return static_cast<std::size_t>(at - keyframes.begin());
}

RobotEstimate::RobotEstimate(const std::string& robot, double t_s, const std::optional<SE2>& start,
                             const RobotEstimateParams& params, const AngleCheckParams& angles)
    : params_(params),
      logs_(robot, Stamp::from_seconds(t_s), start, angles),
      raw_{SE2()},
      poses_{start.value_or(SE2())},
      team_{robot},
      frame_(start ? "" : robot) {
  latest_.pose = poses_.front();
}

void RobotEstimate::move(double t_s, const SE2& step, double sigma_m, double sigma_rad) {
  const std::size_t known = own().stamps().size();
  logs_.say(
      keyframe_of(static_cast<std::uint32_t>(known), Stamp::from_seconds(t_s), step, sigma_m, sigma_rad));
  if (own().stamps().size() == known) return;
  const UncertainPose<SE2>& said = own().steps().back();  // as others read it
  raw_.push_back(raw_.back() * step);
  poses_.push_back(poses_.back() * said.pose);
  latest_ = latest_ * said;
  since_contact_ = since_contact_ * said;
}

void RobotEstimate::see(double t_s, const std::string& robot, const SE2& T_i_j, double sigma_m,
                        double sigma_rad) {
  const auto node = static_cast<std::uint32_t>(size() - 1);
  logs_.say(closure_of(
      node, {node, robot, Stamp::from_seconds(t_s), T_i_j, planar_covariance(sigma_m, sigma_rad)}));
}

void RobotEstimate::refresh() {
  if (!logs_.has_news()) return;
  between_ = logs_.between();
  is_old_ = is_old_ || changes_ != logs_.changes();
  changes_ = logs_.changes();
  own_sightings_ = static_cast<std::size_t>(std::count_if(
      between_.begin(), between_.end(),
      [this](const SightingBetween& each) { return *each.i == logs_.robot() || *each.j == logs_.robot(); }));
}

bool RobotEstimate::has_own_news() {
  refresh();
  return own_sightings_ != used_sightings_;
}

/// This robot and those that sightings tie to it, the nearest first, as long as there are not too many poses.
RobotEstimate::Parts RobotEstimate::connected_parts() const {
  const auto most = static_cast<std::size_t>(params_.max_poses);
  Parts linked;
  linked[logs_.robot()];
  for (const SightingBetween& each : between_) {
    linked[*each.i].keyframes.push_back(each.sighting->keyframe);
    linked[*each.j].keyframes.push_back(each.keyframe_j);
  }
  for (auto& [robot, part] : linked) {
    auto& list = part.keyframes;
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    if (list.size() > most / 2) list.erase(list.begin(), list.end() - static_cast<std::ptrdiff_t>(most / 2));
    if (list.empty() || list.front() != 0) list.insert(list.begin(), 0);
  }
  std::map<std::string_view, std::set<std::string_view>> links;
  for (const SightingBetween& each : between_) {
    if (!pose_in(linked, *each.i, each.sighting->keyframe) || !pose_in(linked, *each.j, each.keyframe_j))
      continue;
    links[*each.i].insert(*each.j);
    links[*each.j].insert(*each.i);
  }
  Parts reached;
  const auto latest = static_cast<std::uint32_t>(size() - 1);
  Part& self = reached[logs_.robot()] = std::move(linked[logs_.robot()]);
  if (self.keyframes.back() != latest) self.keyframes.push_back(latest);
  std::size_t poses = 0;
  std::vector<std::string_view> queue{logs_.robot()};
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (const std::string_view next : links[queue[k]]) {
      const std::string name(next);
      if (reached.contains(name)) continue;
      poses += linked.at(name).keyframes.size();
      if (poses > most && reached.size() > 1) return reached;
      queue.push_back(next);
      reached[name] = std::move(linked.at(name));
    }
  return reached;
}

std::optional<std::size_t> RobotEstimate::pose_in(const Parts& parts, const std::string& robot,
                                                  std::uint32_t keyframe) const {
  const auto part = parts.find(robot);
  if (part == parts.end()) return std::nullopt;
  const auto place = part->second.place_of(keyframe);
  return place ? std::optional(part->second.first + *place) : std::nullopt;
}

/// The common one where a start is known, or that of the first robot by name.
std::string RobotEstimate::frame_of(const Parts& parts) const {
  const bool is_common = std::any_of(parts.begin(), parts.end(), [this](const auto& each) {
    return logs_.all().at(each.first).start().has_value();
  });
  return is_common ? std::string() : parts.begin()->first;
}

/// Probability that a relative pose between two robots is right, or what else its information is scaled by.
double RobotEstimate::weight_of(const AngleEvidence& evidence) const {
  if (params_.angle_weights == "off") return 1;
  if (params_.angle_weights == "published") return evidence.scale;
  const double prior = params_.outlier_ratio;
  if (prior <= 0 || evidence.log_odds == 0) return 1;  // nothing was heard
  return 1 / (1 + prior / (1 - prior) * std::exp(std::min(kMaxLogOdds, evidence.log_odds)));
}

PoseGraph2 RobotEstimate::graph_of(const Parts& parts, const std::string& frame) {
  PoseGraph2 graph;
  for (const auto& [robot, part] : parts) {
    const ReadLog& log = logs_.all().at(robot);
    graph.poses.resize(part.first + part.keyframes.size());
    graph.pose_fixed.resize(graph.poses.size(), false);
    for (std::size_t k = 1; k < part.keyframes.size(); ++k) {
      const auto way = way_between(log, part.keyframes[k - 1], part.keyframes[k]);
      graph.relative_poses.push_back(
          {PoseId(part.first + k - 1), PoseId(part.first + k), way.pose, inverse_of(way.covariance)});
    }
    if (!(frame.empty() ? log.start().has_value() : robot == frame)) continue;
    graph.poses[part.first] = log.start().value_or(SE2());
    graph.pose_fixed[part.first] = true;
  }
  add_sightings(parts, graph);
  return graph;
}

void RobotEstimate::add_sightings(const Parts& parts, PoseGraph2& graph) {
  weights_.assign(own().sightings().size(), 0.0);
  contact_ = {};
  for (const SightingBetween& each : between_) {
    const auto i = pose_in(parts, *each.i, each.sighting->keyframe),
               j = pose_in(parts, *each.j, each.keyframe_j);
    if (!i || !j) continue;
    const double weight = weight_of(*each.sighting->evidence);
    if (*each.i == logs_.robot())
      weights_[static_cast<std::size_t>(each.sighting - own().sightings().data())] = weight;
    RelativePoseFactor<SE2> factor{PoseId(*i), PoseId(*j), each.sighting->T_i_j,
                                   inverse_of(each.sighting->covariance)};
    factor.weight = std::max(weight, kSmallestWeight);
    if (weight >= kRightWeight && *each.i == logs_.robot()) contact_.add(each.sighting->keyframe, factor);
    if (weight >= kRightWeight && *each.j == logs_.robot()) contact_.add(each.keyframe_j, factor);
    graph.relative_poses.push_back(factor);
  }
}

/// Initial values: as they were after the last solution, others where something measured places them.
void RobotEstimate::place(const Parts& parts, PoseGraph2& graph) const {
  std::vector<bool> placed = graph.pose_fixed;
  for (const auto& [robot, part] : parts) {
    const auto before = parts_.find(robot);
    for (std::size_t k = 0; k < part.keyframes.size(); ++k) {
      if (placed[part.first + k]) continue;
      const auto place = before == parts_.end() ? std::nullopt : before->second.place_of(part.keyframes[k]);
      if (robot != logs_.robot() && !place) continue;
      graph.poses[part.first + k] =
          robot == logs_.robot() ? poses_[part.keyframes[k]] : before->second.poses[*place];
      placed[part.first + k] = true;
    }
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& factor : graph.relative_poses) {
      const std::size_t i = factor.i.index(), j = factor.j.index();
      if (placed[i] == placed[j]) continue;
      if (placed[i])
        graph.poses[j] = graph.poses[i] * factor.T_i_j;
      else
        graph.poses[i] = graph.poses[j] * factor.T_i_j.inverse();
      placed[i] = placed[j] = changed = true;
    }
  }
}

/// The own poses, of which the graph has some: of those in between, what odometry expects given both ends,
/// to first order.
void RobotEstimate::spread(const Part& self) {
  poses_.front() = self.poses.front();
  for (std::size_t n = 1; n < self.keyframes.size(); ++n) {
    const std::uint32_t from = self.keyframes[n - 1], to = self.keyframes[n];
    const SE2& begin = self.poses[n - 1];
    poses_[to] = self.poses[n];
    if (to == from + 1) continue;
    const UncertainPose<SE2> whole = way_between(own(), from, to);
    const SE2::Tangent missed =
        inverse_of(whole.covariance) * (whole.pose.inverse() * begin.inverse() * self.poses[n]).log();
    UncertainPose<SE2> way;
    for (std::uint32_t k = from + 1; k < to; ++k) {
      way = way * own().steps()[k];
      const SE2::Jacobian carry = (whole.pose.inverse() * way.pose).adjoint();
      poses_[k] = begin * way.pose * SE2::exp(way.covariance * (carry.transpose() * missed));
    }
  }
}

bool RobotEstimate::solve(Odometry odometry) {
  refresh();
  const bool whole = odometry == Odometry::kWhole;
  if (!is_old_ && !whole) return false;
  is_old_ = false;
  used_sightings_ = own_sightings_;
  Parts parts = connected_parts();
  if (whole)
    for (auto& [robot, part] : parts) {
      part.keyframes.resize(std::size_t{part.keyframes.back()} + 1);
      std::iota(part.keyframes.begin(), part.keyframes.end(), 0U);
    }
  std::size_t poses = 0;
  std::vector<std::string> team;
  for (auto& [robot, part] : parts) {
    part.first = poses;
    poses += part.keyframes.size();
    team.push_back(robot);
  }
  const std::string frame = frame_of(parts);
  PoseGraph2 graph = graph_of(parts, frame);
  place(parts, graph);
  if (whole || team != team_ || frame != frame_) initialise(graph, GivenValues::kComplete);
  OptimizerParams optimizer;
  optimizer.relative_cost_tolerance = kCostTolerance;
  NormalEquations<SE2> equations(graph);
  optimize(graph, equations, optimizer);
  const auto at = [&](std::size_t k) { return graph.poses.begin() + static_cast<std::ptrdiff_t>(k); };
  for (auto& [robot, part] : parts) part.poses.assign(at(part.first), at(part.first + part.keyframes.size()));
  const Part& self = parts.at(logs_.robot());
  spread(self);
  latest_ = {poses_.back(), covariance_in(graph, equations, PoseId(self.first + self.poses.size() - 1))};
  since_contact_ = {SE2(), contact_.covariance()};
  for (std::size_t k = contact_.node + 1; k < size(); ++k) since_contact_ = since_contact_ * own().steps()[k];
  parts_ = std::move(parts);
  team_ = std::move(team);
  frame_ = frame;
  return true;
}

std::optional<SE2> RobotEstimate::pose_of(const std::string& robot, Stamp stamp) const {
  const auto part = parts_.find(robot);
  const auto log = logs_.all().find(robot);
  if (part == parts_.end() || log == logs_.all().end()) return std::nullopt;
  const auto keyframe = log->second.keyframe_at(stamp);
  const auto place = keyframe ? part->second.place_of(*keyframe) : std::nullopt;
  return place ? std::optional(part->second.poses[*place]) : std::nullopt;
}

std::size_t RobotEstimate::sightings_with(const std::string& robot, double since_s) const {
  const Stamp since = Stamp::from_seconds(since_s);
  std::size_t count = 0;
  for (std::size_t k = 0; k < own().sightings().size(); ++k)
    if (own().sightings()[k].robot == robot && own().sightings()[k].stamp >= since && weight(k) > 0) ++count;
  const auto log = logs_.all().find(robot);
  if (log == logs_.all().end()) return count;
  const auto& theirs = log->second.sightings();
  return count +
         static_cast<std::size_t>(std::count_if(theirs.begin(), theirs.end(), [&](const Sighting& each) {
           return each.robot == logs_.robot() && each.stamp >= since;
         }));
}

}  // namespace radioslam
