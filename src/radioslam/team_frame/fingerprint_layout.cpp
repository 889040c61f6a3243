#include "radioslam/team_frame/fingerprint_layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/radio/fingerprints/shared_access_points.hpp"
#include "radioslam/team_frame/layout_uncertainty.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"
#include "radioslam/team_frame/scaled_layouts.hpp"

namespace radioslam {
namespace {

constexpr double kMinAlternative = 0.05;  // relative weight from which another layout is mentioned
constexpr double kOtherPlaces = 2;  // of sigma_0: median displacement from which a layout is another one

/// T_common_start of a robot whose first body pose is known.
SE2 start_from_initial_pose(const SE3& initial_pose, const Robot& robot) {
  return flatten(initial_pose) * flatten(robot.odometry.front().pose).inverse();
}

}  // namespace

std::vector<std::size_t> thinned_nodes(const RadioMeasurements& radio, int most) {
  const auto total_of = [&](std::size_t most_of_robot) {
    std::size_t total = 0;
    for (const auto& robot : radio.robots) total += std::min(robot.size(), most_of_robot);
    return total;
  };
  std::size_t low = 1, high = radio.nodes.size() + 1;  // of a robot: low is always allowed
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (total_of(middle) <= static_cast<std::size_t>(most) ? low : high) = middle;
  }
  std::vector<std::size_t> nodes;
  std::size_t first = 0;
  for (const auto& robot : radio.robots) {
    const std::size_t kept = std::min(robot.size(), low);
    for (std::size_t k = 0; k < kept; ++k) nodes.push_back(first + (2 * k + 1) * robot.size() / (2 * kept));
    first += robot.size();
  }
  return nodes;
}

std::vector<RigidBody> fingerprint_bodies(const Mission& mission, const KnownStarts& starts,
                                          const RadioMeasurements& radio,
                                          const std::vector<std::size_t>& nodes) {
  std::vector<RigidBody> bodies(mission.robots.size());
  for (std::size_t r = 0, first = 0; r < bodies.size(); ++r) {
    const Robot& robot = mission.robots[r];
    std::vector<Eigen::Vector2d> points;
    for (const std::size_t node : nodes)
      if (radio.nodes[node].robot.index() == r)
        points.emplace_back(radio.at(node).T_start_body.translation().head<2>());
    bodies[r].first_node = first;
    bodies[r].points.resize(2, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
      bodies[r].points.col(static_cast<Eigen::Index>(i)) = points[i];
    bodies[r].fixed = starts[r].has_value();
    if (bodies[r].fixed) bodies[r].T_layout_body = start_from_initial_pose(*starts[r], robot);
    if (robot.heading == Heading::kAbsolute) bodies[r].sigma_heading_rad = robot.sigma_heading_rad;
    first += points.size();
  }
  return bodies;
}

namespace {

/// Union-find over robots; the root is the smallest robot index of a group.
class Groups {
 public:
  explicit Groups(std::size_t robots) : parent_(robots) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::size_t root(std::size_t r) const {
    while (parent_[r] != r) r = parent_[r];
    return r;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t root_a = root(a), root_b = root(b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Access points common to similar fingerprints of two robots.
class CommonAccessPoints {
 public:
  /// Adds those of this pair; returns how many the two robots have in common so far.
  std::size_t add(std::size_t robot_a, std::size_t robot_b, const Fingerprint& a, const Fingerprint& b) {
    std::set<AccessPointIndex>& shared = shared_[{robot_a, robot_b}];
    for_each_shared(
        a, b, [&](const FingerprintEntry& x, const FingerprintEntry&) { shared.insert(x.access_point); });
    return shared.size();
  }

 private:
  std::map<std::pair<std::size_t, std::size_t>, std::set<AccessPointIndex>> shared_;
};

Groups group_robots(const KnownStarts& starts, const RadioMeasurements& radio, const LayoutParams& params) {
  Groups groups(starts.size());
  std::optional<std::size_t> known;
  for (std::size_t r = 0; r < starts.size(); ++r) {
    if (!starts[r]) continue;
    if (known) groups.join(*known, r);
    known = known.value_or(r);
  }
  const bool all_known =
      std::all_of(starts.begin(), starts.end(), [](const auto& s) { return s.has_value(); });
  if (!radio.layout_model || all_known) return groups;
  CommonAccessPoints common;
  radio.layout_similarity.for_each_pair(params.min_similarity, [&](const SimilarPair& pair) {
    const std::size_t a = radio.nodes[pair.i].robot.index(), b = radio.nodes[pair.j].robot.index();
    if (groups.root(a) == groups.root(b) || static_cast<double>(pair.similarity) <= params.min_similarity)
      return;
    const std::size_t shared = common.add(a, b, radio.at(pair.i).fingerprint, radio.at(pair.j).fingerprint);
    if (shared >= static_cast<std::size_t>(params.min_shared)) groups.join(a, b);
  });
  return groups;
}

/// Expresses every group in its own frame: the common one where a pose is known, else its first robot's
/// start.
TeamFrame express_in_group_frames(const KnownStarts& starts, const std::vector<RigidBody>& bodies,
                                  const Groups& groups) {
  TeamFrame frame;
  frame.sigma_layout_m.assign(bodies.size(), 0);
  std::vector<bool> known(bodies.size(), false);
  std::vector<int> members(bodies.size(), 0);
  for (std::size_t r = 0; r < bodies.size(); ++r) {
    if (starts[r]) known[groups.root(r)] = true;
    ++members[groups.root(r)];
  }
  std::vector<int> number(bodies.size(), -1);
  int groups_seen = 0;
  for (std::size_t r = 0; r < bodies.size(); ++r) {
    const std::size_t root = groups.root(r);
    if (number[root] < 0) number[root] = groups_seen++;
    const SE2 T_frame_layout = known[root] ? SE2() : bodies[root].T_layout_body.inverse();
    frame.T_team_start.push_back(T_frame_layout * bodies[r].T_layout_body);
    frame.component.push_back(number[root]);
    frame.placed.push_back(number[root] == 0 || members[root] > 1 || known[root]);
  }
  return frame;
}

/// The team's radio field over the nodes.
TeamField field_of(const RadioMeasurements& radio, const std::vector<std::size_t>& nodes,
                   const FieldParams& params) {
  std::vector<FieldNode> field_nodes;
  std::vector<const Fingerprint*> fingerprints;
  for (const std::size_t node : nodes) {
    const Fingerprint& fingerprint = radio.at(node).fingerprint;
    field_nodes.push_back({radio.nodes[node].robot.index(), fingerprint.stamp});
    fingerprints.push_back(&fingerprint);
  }
  const Eigen::MatrixXd heard = fingerprint_powers(fingerprints, params.exponent);
  return {RadioField(std::move(field_nodes), heard, params.channels), heard * heard.transpose()};
}

/// Makes layouts of one team from different evidence.
class LayoutMaker {
 public:
  LayoutMaker(const RadioMeasurements& radio, std::vector<std::size_t> nodes,
              const std::vector<RigidBody>& bodies, const Groups& groups, const LayoutParams& params)
      : radio_(radio), nodes_(std::move(nodes)), bodies_(bodies), params_(params) {
    for (std::size_t b = 0; b < bodies.size(); ++b) group_of_.push_back(groups.root(b));
    for (const std::size_t node : nodes_)
      group_of_node_.push_back(group_of_[radio.nodes[node].robot.index()]);
  }

  const std::vector<std::size_t>& group_of() const { return group_of_; }

  /// By all access points: the layout and its mirror image for each model of distance.
  std::vector<std::vector<Layout>> by_all() const {
    return by([this](std::size_t i, std::size_t j) {
      return static_cast<double>(radio_.layout_similarity.of(nodes_[i], nodes_[j]));
    });
  }

  /// The same by the access points of one half. Empty where similarities do not come from fingerprints.
  std::vector<std::vector<Layout>> by_half(const std::vector<bool>& is_in_second, bool second) const {
    std::vector<Fingerprint> heard;
    for (const std::size_t node : nodes_) {
      heard.push_back(radio_.at(node).fingerprint);
      std::erase_if(heard.back().entries, [&](const FingerprintEntry& entry) {
        return is_in_second[entry.access_point.index()] != second;
      });
    }
    const std::optional<TeamSimilarity> half = radio_.layout_similarity.among(std::move(heard));
    if (!half) return {};
    return by([&](std::size_t i, std::size_t j) { return static_cast<double>(half->of(i, j)); });
  }

 private:
  std::vector<std::vector<Layout>> by(const NodeSimilarity& similarity) const {
    std::vector<std::vector<Layout>> layouts;
    for (LayoutEvidence& evidence : gather_evidence(radio_, similarity, bodies_, params_)) {
      drop_pairs_between_groups(evidence.targets);
      layouts.push_back(scaled_layouts(evidence, bodies_, params_));
    }
    return layouts;
  }

  /// Groups do not share a frame.
  void drop_pairs_between_groups(PairTargets& targets) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (std::size_t j = 0; j < nodes_.size(); ++j)
        if (group_of_node_[i] != group_of_node_[j])
          targets.information(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = 0;
  }

  const RadioMeasurements& radio_;
  std::vector<std::size_t> nodes_, group_of_, group_of_node_;
  const std::vector<RigidBody>& bodies_;
  const LayoutParams& params_;
};

bool is_cheaper(const FieldFit& a, const FieldFit& b) { return a.cost < b.cost; }

/// A layout, and those it was chosen from.
struct ChosenLayout {
  std::vector<RigidBody> bodies;
  std::vector<AlternativeLayout> alternatives;
};

/// The layout that the radio field fits best after a round, fitted further; without a field, the one that
/// fits the first evidence best.
ChosenLayout best_layout(std::vector<std::vector<Layout>> made, const std::vector<std::size_t>& group_of,
                         const TeamField* field, const FieldParams& params, const Progress& progress) {
  if (!field) made.resize(1);
  std::vector<FieldFit> layouts;
  for (std::vector<Layout>& images : made)
    for (Layout& layout : images) {
      report_progress(progress, "team frame", 0.1 + 0.1 * static_cast<double>(layouts.size()));
      const std::size_t robots = layout.bodies.size();
      layouts.push_back({std::move(layout.bodies), FieldModel::nominal(robots), layout.cost});
      if (field) advance_by_field(layouts.back(), *field, params, true);
    }
  const auto first = std::min_element(layouts.begin(), layouts.end(), is_cheaper);
  ChosenLayout chosen;
  for (auto other = layouts.begin(); other != layouts.end(); ++other)
    if (other != first)
      chosen.alternatives.push_back({centre_moves_m(first->bodies, other->bodies, group_of),
                                     std::exp(-std::max(0.0, other->cost - first->cost))});
  FieldFit best = *first;
  for (int round = 1; field && round < params.rounds; ++round) {
    report_progress(progress, "team frame", 0.5 + 0.3 * round / params.rounds);
    advance_by_field(best, *field, params, false);
  }
  chosen.bodies = std::move(best.bodies);
  return chosen;
}

/// Whether most of the bodies that can move lie elsewhere in it.
bool is_elsewhere(const AlternativeLayout& other, const ChosenLayout& chosen, const LayoutParams& params) {
  std::vector<double> moves_m;
  for (std::size_t b = 0; b < chosen.bodies.size(); ++b)
    if (!chosen.bodies[b].fixed && chosen.bodies[b].points.cols() > 0) moves_m.push_back(other.moves_m[b]);
  return !moves_m.empty() && upper_median(moves_m) > kOtherPlaces * params.sigma_m;
}

/// The note on a layout of which another one may be true; nothing where none is likely.
std::optional<std::string> alternatives_note(const ChosenLayout& chosen, const LayoutParams& params) {
  double weight = 0;
  for (const AlternativeLayout& other : chosen.alternatives)
    if (is_elsewhere(other, chosen, params)) weight = std::max(weight, other.weight);
  if (weight < kMinAlternative) return std::nullopt;
  return "another layout of the robots, such as the mirror image, fits their fingerprints nearly as well: "
         "its likelihood is " +
         std::to_string(std::lround(100 * weight)) + " % of that of the layout returned";
}

}  // namespace

TeamFrame align_by_fingerprints(const Mission& mission, const KnownStarts& starts,
                                const RadioMeasurements& radio, const LayoutParams& params,
                                const FieldParams& field, const Progress& progress) {
  const Groups groups = group_robots(starts, radio, params);
  const std::vector<std::size_t> nodes = thinned_nodes(radio, params.max_nodes);
  const std::vector<RigidBody> bodies = fingerprint_bodies(mission, starts, radio, nodes);
  const bool all_known = std::all_of(bodies.begin(), bodies.end(), [](const auto& b) { return b.fixed; });
  if (!radio.layout_model || all_known) return express_in_group_frames(starts, bodies, groups);
  const LayoutMaker maker(radio, nodes, bodies, groups, params);
  std::optional<TeamField> team_field;
  if (field.enabled) team_field = field_of(radio, nodes, field);
  const ChosenLayout chosen =
      best_layout(maker.by_all(), maker.group_of(), team_field ? &*team_field : nullptr, field, progress);
  report_progress(progress, "team frame", 0.8);
  const std::vector<bool> is_in_second = second_half(mission.access_points);
  std::vector<std::vector<Layout>> by_halves = maker.by_half(is_in_second, false);
  report_progress(progress, "team frame", 0.9);
  for (auto& images : maker.by_half(is_in_second, true)) by_halves.push_back(std::move(images));
  TeamFrame frame = express_in_group_frames(starts, chosen.bodies, groups);
  frame.sigma_layout_m =
      layout_sigmas_m(chosen.bodies, by_halves, chosen.alternatives, maker.group_of(), params);
  frame.note = alternatives_note(chosen, params);
  return frame;
}

}  // namespace radioslam
