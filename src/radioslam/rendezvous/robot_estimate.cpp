#include "radioslam/rendezvous/robot_estimate.hpp"

#include <algorithm>
#include <cmath>
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

/// The others that sightings tie to this robot, the nearest first, as long as there are not too many poses.
RobotEstimate::Parts RobotEstimate::connected_parts() const {
  const auto most = static_cast<std::size_t>(params_.max_poses);
  Parts linked;
  const auto link = [&](const std::string& robot, std::uint32_t keyframe) {
    if (robot != logs_.robot()) linked[robot].keyframes.push_back(keyframe);
  };
  for (const SightingBetween& each : between_) {
    link(*each.i, each.sighting->keyframe);
    link(*each.j, each.keyframe_j);
  }
  for (auto& [robot, part] : linked) {
    auto& list = part.keyframes;
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    if (list.size() > most / 2) list.erase(list.begin(), list.end() - static_cast<std::ptrdiff_t>(most / 2));
    if (list.front() != 0) list.insert(list.begin(), 0);
  }
  std::map<std::string_view, std::set<std::string_view>> links;
  for (const SightingBetween& each : between_) {
    if (!pose_in(linked, *each.i, each.sighting->keyframe) || !pose_in(linked, *each.j, each.keyframe_j))
      continue;
    links[*each.i].insert(*each.j);
    links[*each.j].insert(*each.i);
  }
  Parts reached;
  std::size_t poses = 0;
  std::vector<std::string_view> queue{logs_.robot()};
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (const std::string_view next : links[queue[k]]) {
      const std::string name(next);
      if (next == logs_.robot() || reached.contains(name)) continue;
      poses += linked.at(name).keyframes.size();
      if (poses > most && !reached.empty()) return reached;
      queue.push_back(next);
      reached[name] = std::move(linked.at(name));
    }
  return reached;
}

std::optional<std::size_t> RobotEstimate::pose_in(const Parts& parts, const std::string& robot,
                                                  std::uint32_t keyframe) const {
  if (robot == logs_.robot()) return keyframe;
  const auto part = parts.find(robot);
  if (part == parts.end()) return std::nullopt;
  const auto place = part->second.place_of(keyframe);
  return place ? std::optional(part->second.first + *place) : std::nullopt;
}

/// The common one where a start is known, or that of the first robot by name.
std::string RobotEstimate::frame_of(const Parts& parts) const {
  const auto has_start = [this](const auto& each) { return logs_.all().at(each.first).start().has_value(); };
  if (own().start() || std::any_of(parts.begin(), parts.end(), has_start)) return {};
  return parts.empty() ? logs_.robot() : std::min(logs_.robot(), parts.begin()->first);
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
  graph.poses = poses_;
  const auto add_part = [&](const std::string& robot, std::size_t first, std::size_t count,
                            auto keyframe_at) {
    const ReadLog& log = logs_.all().at(robot);
    graph.poses.resize(std::max(graph.poses.size(), first + count));
    graph.pose_fixed.resize(graph.poses.size(), false);
    for (std::size_t k = 1; k < count; ++k) {
      UncertainPose<SE2> step = log.steps()[keyframe_at(k - 1) + 1];
      for (std::size_t next = keyframe_at(k - 1) + 2; next <= keyframe_at(k); ++next)
        step = step * log.steps()[next];
      graph.relative_poses.push_back(
          {PoseId(first + k - 1), PoseId(first + k), step.pose, inverse_of(step.covariance)});
    }
    if (!(frame.empty() ? log.start().has_value() : robot == frame)) return;
    graph.poses[first] = log.start().value_or(SE2());
    graph.pose_fixed[first] = true;
  };
  add_part(logs_.robot(), 0, size(), [](std::size_t k) { return k; });
  for (const auto& [robot, part] : parts)
    add_part(robot, part.first, part.keyframes.size(),
             [&keyframes = part.keyframes](std::size_t k) { return std::size_t{keyframes[k]}; });
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
    for (const std::size_t end : {*i, *j})
      if (end < size() && weight >= kRightWeight) contact_.add(end, factor);
    graph.relative_poses.push_back(factor);
  }
}

/// Initial values: as they were after the last solution, others where something measured places them.
void RobotEstimate::place(const Parts& parts, PoseGraph2& graph) const {
  std::vector<bool> placed = graph.pose_fixed;
  std::fill_n(placed.begin(), size(), true);
  for (const auto& [robot, part] : parts) {
    const auto before = parts_.find(robot);
    if (before == parts_.end()) continue;
    for (std::size_t k = 0; k < part.keyframes.size(); ++k) {
      const auto place = before->second.place_of(part.keyframes[k]);
      if (!place || placed[part.first + k]) continue;
      graph.poses[part.first + k] = before->second.poses[*place];
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

bool RobotEstimate::solve() {
  refresh();
  if (!is_old_) return false;
  is_old_ = false;
  used_sightings_ = own_sightings_;
  Parts parts = connected_parts();
  std::size_t poses = size();
  std::vector<std::string> team{logs_.robot()};
  for (auto& [robot, part] : parts) {
    part.first = poses;
    poses += part.keyframes.size();
    team.push_back(robot);
  }
  std::sort(team.begin(), team.end());
  const std::string frame = frame_of(parts);
  PoseGraph2 graph = graph_of(parts, frame);
  place(parts, graph);
  if (team != team_ || frame != frame_) initialise(graph, GivenValues::kComplete);
  OptimizerParams optimizer;
  optimizer.relative_cost_tolerance = kCostTolerance;
  NormalEquations<SE2> equations(graph);
  optimize(graph, equations, optimizer);
  const auto at = [&](std::size_t k) { return graph.poses.begin() + static_cast<std::ptrdiff_t>(k); };
  poses_.assign(at(0), at(size()));
  for (auto& [robot, part] : parts) part.poses.assign(at(part.first), at(part.first + part.keyframes.size()));
  latest_ = {poses_.back(), covariance_in(graph, equations, PoseId(size() - 1))};
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
