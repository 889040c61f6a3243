#include "radioslam/graph/distributed/condensed/known_team.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/initial_values.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {
namespace {

constexpr double kSmallestSigma = 1e-6;  ///< m and rad, where none is stated
constexpr double kRightWeight = 0.5;     ///< a relative pose of less is taken for wrong
constexpr double kSmallestWeight = 1e-9;
constexpr double kCostTolerance = 1e-7;
constexpr double kMaxLogOdds = 50;
constexpr double kUnknownVariance = 1e12;

SE2::Jacobian covariance_of(double sigma_m, double sigma_rad) {
  const double m = std::max(sigma_m, kSmallestSigma), rad = std::max(sigma_rad, kSmallestSigma);
  return SE2::Tangent(m * m, m * m, rad * rad).asDiagonal();
}

/// Until when a pose that no other follows yet is the latest, as far as is known at a time.
double just_after(double t_s) {
  return t_s + 64 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(t_s));
}

/// The latest entries of a list in no order; as many as a message holds.
template <class Entry>
void keep_latest(std::vector<Entry>& list) {
  if (list.size() <= kMaxSharedEntries) return;
  std::stable_sort(list.begin(), list.end(), [](const Entry& a, const Entry& b) { return a.t_s < b.t_s; });
  list.erase(list.begin(), list.end() - static_cast<std::ptrdiff_t>(kMaxSharedEntries));
}

SE2::Jacobian inverse_of(const SE2::Jacobian& covariance) {
  return Cholesky<SE2::Jacobian>(covariance).inverse();
}

}  // namespace

/// The poses of a graph: all own ones first, then those of other robots by name.
struct KnownTeam::Layout {
  struct Robot {
    KnownTeam::PartPointer part;
    std::size_t first = 0;  ///< pose of its start
  };
  std::map<std::string, Robot> robots;  ///< others
  std::size_t poses = 0;
  bool common = false;  ///< a start is known
  std::string origin;   ///< where none is
};

void KnownTeam::Contact::add(std::size_t at, const RelativePoseFactor<SE2>& seen) {
  if (at > node || !information) {
    node = at;
    information = SE2::Jacobian::Zero();
  }
  if (at == node) *information += seen.weight * seen.information;
}

SE2::Jacobian KnownTeam::Contact::covariance() const {
  return information ? inverse_of(*information) : SE2::Jacobian::Zero();
}

KnownTeam::KnownTeam(std::string robot, double t_s, const std::optional<SE2>& start,
                     const KnownTeamParams& params)
    : params_(params),
      robot_(std::move(robot)),
      start_(start),
      times_{t_s},
      raw_{SE2()},
      poses_{start.value_or(SE2())},
      shared_{0},
      version_(first_number(t_s)),
      team_{robot_},
      frame_(start ? "" : robot_) {
  latest_.pose = poses_.front();
}

void KnownTeam::move(double t_s, const SE2& step, double sigma_m, double sigma_rad) {
  times_.push_back(t_s);
  raw_.push_back(raw_.back() * step);
  poses_.push_back(poses_.back() * step);
  steps_.push_back({step, covariance_of(sigma_m, sigma_rad)});
  latest_ = latest_ * steps_.back();
  since_contact_ = since_contact_ * steps_.back();
  // Until when the latest shared pose was the robot's latest is part of what it shares.
  if (shared_.back() + 2 == times_.size()) part_is_old_ = true;
}

void KnownTeam::share_node(std::uint32_t number) {
  const auto at = std::lower_bound(shared_.begin(), shared_.end(), number);
  if (at == shared_.end() || *at != number) {
    shared_.insert(at, number);
    part_is_old_ = true;
  }
  estimate_is_old_ = true;
}

/// Observations between this robot and the one whose part it is that can be put into a graph.
std::size_t KnownTeam::observations_between(const SharedPart& part) const {
  const auto of_this = std::count_if(part.observations.begin(), part.observations.end(),
                                     [&](const SharedObservation& each) { return each.robot == robot_; });
  const auto of_it = std::count_if(
      observations_.begin(), observations_.end(),
      [&](const SharedObservation& each) { return each.robot == part.robot && part.node_at(each.t_s); });
  return static_cast<std::size_t>(of_this + of_it);
}

void KnownTeam::see(double t_s, const std::string& robot, const SE2& T_i_j, double sigma_m, double sigma_rad,
                    const AngleEvidence& evidence) {
  const auto node = static_cast<std::uint32_t>(times_.size() - 1);
  // Times are keys: of several observations at one time, each gets the next number.
  auto from = observations_.size();
  while (from > 0 && observations_[from - 1].node == node) --from;
  for (; from < observations_.size(); ++from)
    if (observations_[from].robot == robot && observations_[from].t_s == t_s)
      t_s = std::nextafter(t_s, std::numeric_limits<double>::infinity());
  observations_.push_back({node, robot, t_s, T_i_j, std::max(sigma_m, kSmallestSigma),
                           std::max(sigma_rad, kSmallestSigma), evidence});
  weights_.push_back(0);
  links_[robot_].insert(robot);
  links_[robot].insert(robot_);
  part_is_old_ = true;
  share_node(node);
}

std::optional<std::uint32_t> KnownTeam::own_node_at(double t_s) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), t_s);
  if (after == times_.begin()) return std::nullopt;
  return static_cast<std::uint32_t>(after - times_.begin() - 1);
}

bool KnownTeam::take(const PartPointer& part) {
  if (!part || part->robot == robot_) return false;
  const auto known = parts_.find(part->robot);
  if (known != parts_.end() && known->second->version >= part->version) return false;
  if (!is_well_formed(*part)) return false;
  const std::size_t before = known == parts_.end() ? 0 : observations_between(*known->second);
  if (observations_between(*part) != before || before >= kMaxSharedEntries) own_news_ = true;
  parts_[part->robot] = part;
  for (const SharedObservation& observation : part->observations) {
    links_[part->robot].insert(observation.robot);
    links_[observation.robot].insert(part->robot);
    if (observation.robot == robot_)
      if (const auto node = own_node_at(observation.t_s)) share_node(*node);
  }
  estimate_is_old_ = true;
  return true;
}

std::vector<UnjudgedObservation> KnownTeam::unjudged() const {
  std::vector<UnjudgedObservation> list;
  for (const auto& [name, part] : parts_)
    for (const SharedObservation& observation : part->observations) {
      if (observation.robot != robot_ || evidence_.contains({name, observation.t_s})) continue;
      if (const auto node = own_node_at(observation.t_s))
        list.push_back({name, *node, observation.t_s, observation.T_i_j.inverse(), observation.sigma_m,
                        observation.sigma_rad});
    }
  return list;
}

void KnownTeam::judge(const std::string& by, double t_s, const AngleEvidence& evidence) {
  evidence_[{by, t_s}] = evidence;
  part_is_old_ = estimate_is_old_ = true;
}

/// The start and the latest of the poses that others may refer to: as many as a message holds.
std::vector<std::uint32_t> KnownTeam::latest_shared() const {
  if (shared_.size() <= kMaxSharedNodes) return shared_;
  std::vector<std::uint32_t> list{0};
  list.insert(list.end(), shared_.end() - static_cast<std::ptrdiff_t>(kMaxSharedNodes - 1), shared_.end());
  return list;
}

KnownTeam::PartPointer KnownTeam::own_part(double now_s) {
  if (!part_is_old_ && own_part_) return own_part_;
  auto part = std::make_shared<SharedPart>();
  part->robot = robot_;
  part->version = ++version_;
  part->start = start_;
  std::uint32_t before = 0;
  for (const std::uint32_t number : latest_shared()) {
    SharedNode node{
        number, times_[number], number + 1 < times_.size() ? times_[number + 1] : just_after(now_s), {}};
    // A pose that another follows is the latest until just before.
    if (number + 1 < times_.size()) node.until_s = std::max(node.t_s, std::nextafter(node.until_s, node.t_s));
    for (std::uint32_t step = before; step < number; ++step)
      node.from_before = step == before ? steps_[step] : node.from_before * steps_[step];
    before = number;
    part->nodes.push_back(std::move(node));
  }
  for (const SharedObservation& observation : observations_)
    if (part->place_of(observation.node) < part->nodes.size()) part->observations.push_back(observation);
  for (const auto& [key, evidence] : evidence_)
    if (part->node_at(key.second)) part->evidence.push_back({key.first, key.second, evidence});
  keep_latest(part->observations);
  keep_latest(part->evidence);
  own_part_ = std::move(part);
  part_is_old_ = false;
  return own_part_;
}

std::vector<KnownTeam::Between> KnownTeam::all_observations() const {
  std::vector<Between> list;
  const auto add = [&](const std::string& from, const std::vector<SharedObservation>& observations) {
    for (const SharedObservation& observation : observations) {
      Between between{&observation, &from, {}};
      if (observation.robot == robot_) {
        if (!own_node_at(observation.t_s)) continue;
        const auto evidence = evidence_.find({from, observation.t_s});
        if (evidence != evidence_.end()) between.at_seen = evidence->second;
        list.push_back(between);
        continue;
      }
      const auto part = parts_.find(observation.robot);
      if (part == parts_.end() || !part->second->node_at(observation.t_s)) continue;
      for (const SharedEvidence& evidence : part->second->evidence)
        if (evidence.by == from && evidence.t_s == observation.t_s) between.at_seen = evidence.angles;
      list.push_back(between);
    }
  };
  add(robot_, observations_);
  for (const auto& [name, part] : parts_) add(name, part->observations);
  return list;
}

/// The known parts of the robots that observations lead to from one, the nearest first, without its own; at
/// most as many as may be used.
std::vector<KnownTeam::PartPointer> KnownTeam::parts_around(const std::string& robot, int hops) const {
  std::vector<PartPointer> list;
  std::vector<const std::string*> queue{&robot};
  std::vector<int> depth{0};
  std::set<std::string_view> reached{robot};
  std::size_t poses = 0;
  for (std::size_t k = 0; k < queue.size() && depth[k] < hops; ++k) {
    const auto links = links_.find(*queue[k]);
    if (links == links_.end()) continue;
    for (const std::string& next : links->second) {
      if (!reached.insert(next).second) continue;
      queue.push_back(&next);
      depth.push_back(depth[k] + 1);
      const auto known = parts_.find(next);
      const PartPointer part = next == robot_ ? own_part_ : known == parts_.end() ? nullptr : known->second;
      if (!part) continue;
      poses += part->nodes.size();
      if (poses > static_cast<std::size_t>(params_.max_poses) && !list.empty()) return list;
      list.push_back(part);
    }
  }
  return list;
}

std::vector<KnownTeam::PartPointer> KnownTeam::parts_for(const std::string& robot, double now_s) {
  own_part(now_s);
  return parts_around(robot, params_.hops);
}

/// This robot and those that usable observations connect with it, the nearest first.
KnownTeam::Layout KnownTeam::connected_part(const std::vector<Between>& between) const {
  constexpr int kAnyNumberOfHops = std::numeric_limits<int>::max();
  std::map<std::string_view, PartPointer> candidates;
  for (const PartPointer& part : parts_around(robot_, kAnyNumberOfHops)) candidates[part->robot] = part;
  std::map<std::string_view, std::set<std::string_view>> links;
  for (const Between& each : between) {
    links[*each.from].insert(each.observation->robot);
    links[each.observation->robot].insert(*each.from);
  }
  Layout layout;
  layout.poses = times_.size();
  layout.common = start_.has_value();
  layout.origin = robot_;
  std::vector<std::string_view> queue{robot_};
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (const std::string_view next : links[queue[k]]) {
      const auto part = candidates.find(next);
      if (part == candidates.end()) continue;
      const std::string name(next);
      layout.robots[name] = {part->second, 0};
      layout.common = layout.common || part->second->start;
      layout.origin = std::min(layout.origin, name);
      queue.push_back(layout.robots.at(name).part->robot);
      candidates.erase(part);
    }
  for (auto& [name, robot] : layout.robots) {
    robot.first = layout.poses;
    layout.poses += robot.part->nodes.size();
  }
  return layout;
}

/// Probability that a relative pose between two robots is right, or what else its information is scaled by.
double KnownTeam::weight_of(const Between& between) const {
  const AngleEvidence& here = between.observation->evidence;
  if (params_.angle_weights == "off") return 1;
  if (params_.angle_weights == "published") return here.scale * between.at_seen.scale;
  const double prior = params_.outlier_ratio, log_odds = here.log_odds + between.at_seen.log_odds;
  if (prior <= 0 || log_odds == 0) return 1;  // nothing was heard
  return 1 / (1 + prior / (1 - prior) * std::exp(std::min(kMaxLogOdds, log_odds)));
}

PoseGraph2 KnownTeam::graph_of(const Layout& layout, const std::vector<Between>& between) {
  PoseGraph2 graph;
  graph.poses = poses_;
  graph.poses.resize(layout.poses);
  graph.pose_fixed.assign(layout.poses, false);
  const auto add_step = [&](std::size_t i, std::size_t j, const UncertainPose<SE2>& step) {
    graph.relative_poses.push_back({PoseId(i), PoseId(j), step.pose, inverse_of(step.covariance)});
  };
  const auto place_start = [&](std::size_t pose, const std::string& name, const std::optional<SE2>& start) {
    if (!(layout.common ? start.has_value() : name == layout.origin)) return;
    graph.poses[pose] = start.value_or(SE2());
    graph.pose_fixed[pose] = true;
  };
  for (std::size_t k = 0; k < steps_.size(); ++k) add_step(k, k + 1, steps_[k]);
  place_start(0, robot_, start_);
  for (const auto& [name, robot] : layout.robots) {
    for (std::size_t k = 1; k < robot.part->nodes.size(); ++k)
      add_step(robot.first + k - 1, robot.first + k, robot.part->nodes[k].from_before);
    place_start(robot.first, name, robot.part->start);
  }
  const auto pose_at = [&](const std::string& name, double t_s) -> std::optional<std::size_t> {
    if (name == robot_) return own_node_at(t_s);
    const auto robot = layout.robots.find(name);
    if (robot == layout.robots.end()) return std::nullopt;
    const SharedNode* node = robot->second.part->node_at(t_s);
    if (!node) return std::nullopt;
    return robot->second.first + static_cast<std::size_t>(node - robot->second.part->nodes.data());
  };
  std::fill(weights_.begin(), weights_.end(), 0.0);
  contact_ = {};
  for (const Between& each : between) {
    const SharedObservation& observation = *each.observation;
    std::optional<std::size_t> i;
    if (*each.from == robot_) {
      i = observation.node;
    } else if (const auto robot = layout.robots.find(*each.from); robot != layout.robots.end()) {
      i = robot->second.first + robot->second.part->place_of(observation.node);
    }
    const auto j = pose_at(observation.robot, observation.t_s);
    if (!i || !j) continue;
    const double weight = weight_of(each);
    if (*each.from == robot_)
      weights_[static_cast<std::size_t>(each.observation - observations_.data())] = weight;
    RelativePoseFactor<SE2> factor{PoseId(*i), PoseId(*j), observation.T_i_j,
                                   inverse_of(covariance_of(observation.sigma_m, observation.sigma_rad))};
    factor.weight = std::max(weight, kSmallestWeight);
    for (const std::size_t end : {*i, *j})
      if (end < times_.size() && weight >= kRightWeight) contact_.add(end, factor);
    graph.relative_poses.push_back(factor);
  }
  return graph;
}

/// Initial values: as they were after the last solution, others where something measured places them.
void KnownTeam::place(const Layout& layout, PoseGraph2& graph) const {
  std::vector<bool> placed = graph.pose_fixed;
  std::fill_n(placed.begin(), times_.size(), true);
  for (const auto& [name, robot] : layout.robots) {
    const auto used = used_parts_.find(name);
    if (used == used_parts_.end()) continue;
    for (std::size_t k = 0; k < robot.part->nodes.size(); ++k) {
      const std::size_t before = used->second->place_of(robot.part->nodes[k].number);
      if (before == used->second->nodes.size()) continue;
      graph.poses[robot.first + k] = others_.at(name)[before];
      placed[robot.first + k] = true;
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

/// Of the latest pose; as good as unknown where it cannot be computed.
SE2::Jacobian KnownTeam::latest_covariance(const PoseGraph2& graph) const {
  if (const auto marginals = Marginals<SE2>::compute(graph)) {
    const SE2::Jacobian covariance = marginals->pose(PoseId(times_.size() - 1));
    if (covariance.allFinite()) return covariance;
  }
  return kUnknownVariance * SE2::Jacobian::Identity();
}

bool KnownTeam::solve() {
  if (!estimate_is_old_) return false;
  estimate_is_old_ = false;
  own_news_ = false;
  const std::vector<Between> between = all_observations();
  const Layout layout = connected_part(between);
  PoseGraph2 graph = graph_of(layout, between);
  place(layout, graph);
  initialise(graph, GivenValues::kComplete);
  OptimizerParams optimizer;
  optimizer.relative_cost_tolerance = kCostTolerance;
  optimize(graph, optimizer);
  poses_.assign(graph.poses.begin(), graph.poses.begin() + static_cast<std::ptrdiff_t>(times_.size()));
  latest_ = {poses_.back(), latest_covariance(graph)};
  since_contact_ = {SE2(), contact_.covariance()};
  for (std::size_t k = contact_.node; k < steps_.size(); ++k) since_contact_ = since_contact_ * steps_[k];
  others_.clear();
  used_parts_.clear();
  team_ = {robot_};
  for (const auto& [name, robot] : layout.robots) {
    const auto begin = graph.poses.begin() + static_cast<std::ptrdiff_t>(robot.first);
    others_[name].assign(begin, begin + static_cast<std::ptrdiff_t>(robot.part->nodes.size()));
    used_parts_[name] = robot.part;
    team_.push_back(name);
  }
  frame_ = layout.common ? "" : layout.origin;
  std::sort(team_.begin(), team_.end());
  return true;
}

std::optional<SE2> KnownTeam::pose_of(const std::string& robot, double t_s) const {
  const auto part = used_parts_.find(robot);
  if (part == used_parts_.end()) return std::nullopt;
  const SharedNode* node = part->second->node_at(t_s);
  if (!node) return std::nullopt;
  return others_.at(robot)[static_cast<std::size_t>(node - part->second->nodes.data())];
}

std::size_t KnownTeam::observations_with(const std::string& robot, double since_s) const {
  std::size_t count = 0;
  for (std::size_t k = 0; k < observations_.size(); ++k)
    if (observations_[k].robot == robot && observations_[k].t_s >= since_s && weights_[k] > 0) ++count;
  const auto part = parts_.find(robot);
  if (part == parts_.end()) return count;
  for (const SharedObservation& observation : part->second->observations)
    if (observation.robot == robot_ && observation.t_s >= since_s) ++count;
  return count;
}

}  // namespace radioslam
