#include "radioslam/team_frame/fingerprint_layout.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/radio/fingerprints/shared_access_points.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {
namespace {

std::size_t end_of(const RigidBody& body) {
  return body.first_node + static_cast<std::size_t>(body.points.cols());
}

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

constexpr Eigen::Index kSubspace = 6;  // two, and a guard against near-equal eigenvalues
constexpr int kIterations = 100;

/// -1/2 J D^2 J with J = I - 1/n.
Eigen::MatrixXd doubly_centred(const Eigen::MatrixXd& distances) {
  Eigen::MatrixXd b = -0.5 * distances.array().square().matrix();
  const Eigen::RowVectorXd column_means = b.colwise().mean();
  b.rowwise() -= column_means;
  const Eigen::VectorXd row_means = b.rowwise().mean();
  b.colwise() -= row_means;
  return b;
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& m) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(m).householderQ() *
         Eigen::MatrixXd::Identity(m.rows(), m.cols());
}

}  // namespace

Eigen::Matrix2Xd classical_scaling(const Eigen::MatrixXd& distances_m) {
  const Eigen::Index n = distances_m.rows();
  const Eigen::Index k = std::min(kSubspace, n);
  if (n < 2) return Eigen::Matrix2Xd::Zero(2, n);
  const Eigen::MatrixXd b = doubly_centred(distances_m);

  // Subspace iteration from a fixed start. Only the two largest positive eigenvalues are used; distances that
  // no planar configuration realises also give negative ones.
  Rng rng(1);
  Eigen::MatrixXd q = Eigen::MatrixXd::NullaryExpr(n, k, [&] { return rng.normal(); });
  q = orthonormal(q);
  for (int i = 0; i < kIterations; ++i) q = orthonormal(b * q);
  const auto small = symmetric_eigen<Eigen::MatrixXd>(q.transpose() * b * q);
  Eigen::Matrix2Xd points = Eigen::Matrix2Xd::Zero(2, n);
  for (Eigen::Index axis = 0; axis < std::min<Eigen::Index>(2, k); ++axis) {
    const Eigen::Index e = k - 1 - axis;
    const double scale = std::sqrt(std::max(0.0, small.values[e]));
    points.row(axis) = scale * (q * small.vectors.col(e)).transpose();
  }
  return points;
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
  if (!radio.layout_model) return groups;
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

/// Distances of paths through a graph of fingerprints whose edges are odometry within a robot, known
/// positions between robots of known start, and predicted distances between similar fingerprints of two
/// robots.
class FingerprintGraph {
 public:
  explicit FingerprintGraph(std::size_t nodes) : edges_(nodes) {}
  void connect(std::size_t i, std::size_t j, double distance_m) {
    edges_[i].push_back({j, distance_m});
    edges_[j].push_back({i, distance_m});
  }
  /// Shortest paths between any two nodes (Dijkstra 1959), infinite where there is none.
  Eigen::MatrixXd shortest_paths() const {
    const auto n = static_cast<Eigen::Index>(edges_.size());
    Eigen::MatrixXd paths = Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::infinity());
    parallel_for(edges_.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) find_paths_from(i, paths.col(static_cast<Eigen::Index>(i)));
    });
    return paths;
  }

 private:
  struct Edge {
    std::size_t to = 0;
    double distance_m = 0;
  };

  void find_paths_from(std::size_t source, Eigen::Ref<Eigen::VectorXd> paths) const {
    using Reached = std::pair<double, std::size_t>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    paths[static_cast<Eigen::Index>(source)] = 0;
    queue.emplace(0, source);
    while (!queue.empty()) {
      const auto [distance, at] = queue.top();
      queue.pop();
      if (distance > paths[static_cast<Eigen::Index>(at)]) continue;
      for (const Edge& edge : edges_[at]) {
        double& known = paths[static_cast<Eigen::Index>(edge.to)];
        if (distance + edge.distance_m >= known) continue;
        known = distance + edge.distance_m;
        queue.emplace(known, edge.to);
      }
    }
  }

  std::vector<std::vector<Edge>> edges_;
};

/// The nodes' most similar nodes of other robots, most similar first.
std::vector<std::vector<std::size_t>> similar_nodes(const RadioMeasurements& radio,
                                                    const std::vector<std::size_t>& nodes, std::size_t most) {
  std::vector<std::vector<std::size_t>> similar(nodes.size());
  parallel_for(nodes.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<std::pair<float, std::size_t>> others;
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        if (radio.nodes[nodes[i]].robot == radio.nodes[nodes[j]].robot) continue;
        const float s = radio.layout_similarity.of(nodes[i], nodes[j]);
        if (s > 0) others.emplace_back(-s, j);
      }
      const auto kept = static_cast<std::ptrdiff_t>(std::min(most, others.size()));
      std::partial_sort(others.begin(), others.begin() + kept, others.end());
      for (std::ptrdiff_t k = 0; k < kept; ++k)
        similar[i].push_back(others[static_cast<std::size_t>(k)].second);
    }
  });
  return similar;
}

/// Metres by similarity.
using PredictDistance = std::function<double(double similarity)>;

/// What the layout is fitted to.
struct LayoutEvidence {
  Eigen::MatrixXd distances_m;  ///< nodes x nodes, for the scaling; infinite where there is none
  PairTargets targets;
};

/// Predicted distances to each node's most similar ones, and odometry within robots of known relative pose.
FingerprintGraph connect(const RadioMeasurements& radio, const std::vector<std::size_t>& nodes,
                         const std::vector<std::vector<std::size_t>>& similar,
                         const std::vector<RigidBody>& bodies, const PredictDistance& predict_m,
                         Eigen::MatrixXf& predicted_m) {
  FingerprintGraph graph(nodes.size());
  const Eigen::Matrix2Xd positions = node_positions(bodies);
  for (const RigidBody& a : bodies)
    for (const RigidBody& b : bodies) {
      if (&a > &b || (&a != &b && !(a.fixed && b.fixed))) continue;
      for (std::size_t i = a.first_node; i < end_of(a); ++i)
        for (std::size_t j = &a == &b ? i + 1 : b.first_node; j < end_of(b); ++j)
          graph.connect(
              i, j,
              (positions.col(static_cast<Eigen::Index>(i)) - positions.col(static_cast<Eigen::Index>(j)))
                  .norm());
    }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const std::size_t j : similar[i]) {
      const auto s = static_cast<double>(radio.layout_similarity.of(nodes[i], nodes[j]));
      const double distance = predict_m(s);
      graph.connect(i, j, distance);
      const auto p = static_cast<Eigen::Index>(i), q = static_cast<Eigen::Index>(j);
      predicted_m(p, q) = predicted_m(q, p) = static_cast<float>(distance);
    }
  return graph;
}

/// Paths through the graph; predicted distances of similar nodes as they are. The others weigh
/// `params.far_weight` times as much as these, all together.
LayoutEvidence evidence_of_paths(const RadioMeasurements& radio, const std::vector<std::size_t>& nodes,
                                 const std::vector<std::vector<std::size_t>>& similar,
                                 const std::vector<RigidBody>& bodies, const PredictDistance& predict_m,
                                 const LayoutParams& params) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXf predicted_m = Eigen::MatrixXf::Constant(n, n, -1);
  LayoutEvidence evidence{connect(radio, nodes, similar, bodies, predict_m, predicted_m).shortest_paths(),
                          {Eigen::MatrixXf::Zero(n, n), Eigen::MatrixXf::Zero(n, n),
                           Eigen::MatrixXf::Constant(n, n, static_cast<float>(params.pair_weight))}};
  PairTargets& targets = evidence.targets;
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double distance = evidence.distances_m(i, j);
      if (!std::isfinite(distance) || radio.nodes[nodes[static_cast<std::size_t>(i)]].robot ==
                                          radio.nodes[nodes[static_cast<std::size_t>(j)]].robot)
        continue;
      targets.distance_m(i, j) = static_cast<float>(distance);
      targets.information(i, j) = static_cast<float>(
          1 / (params.sigma_m * params.sigma_m + std::pow(params.sigma_relative * distance, 2)));
    }
  const auto is_near = predicted_m.array() >= 0;
  const auto near = static_cast<double>(is_near.count());
  const double far = static_cast<double>((targets.information.array() > 0).count()) - near;
  if (far > 0)
    targets.weight =
        is_near.select(targets.weight, targets.weight * static_cast<float>(params.far_weight * near / far));
  targets.distance_m = is_near.select(predicted_m, targets.distance_m);
  return evidence;
}

/// By both models of distance: the medians know no far distances where robots went short ways, and the law of
/// decay does not hold everywhere.
std::vector<LayoutEvidence> gather_evidence(const RadioMeasurements& radio,
                                            const std::vector<std::size_t>& nodes,
                                            const std::vector<RigidBody>& bodies,
                                            const LayoutParams& params) {
  const auto similar = similar_nodes(radio, nodes, static_cast<std::size_t>(params.neighbours));
  std::vector<LayoutEvidence> evidence;
  const auto add = [&](const auto& model) {
    evidence.push_back(evidence_of_paths(
        radio, nodes, similar, bodies, [&](double similarity) { return model.distance_m(similarity); },
        params));
  };
  add(*radio.layout_model);
  if (radio.decay_model) add(*radio.decay_model);
  return evidence;
}

/// Transform from the scaled points to the layout's frame: fitted to the robots with known pose, else a
/// rotation to the common heading, else the identity.
SE2 alignment_to_frame(const std::vector<RigidBody>& bodies, const Eigen::Matrix2Xd& scaled) {
  std::vector<Eigen::Index> known;
  double sine = 0, cosine = 0;
  const Eigen::Matrix2Xd positions = node_positions(bodies);
  for (const RigidBody& body : bodies) {
    const auto first = static_cast<Eigen::Index>(body.first_node);
    if (body.fixed)
      for (Eigen::Index i = 0; i < body.points.cols(); ++i) known.push_back(first + i);
    if (body.sigma_heading_rad <= 0 || body.points.cols() < 2) continue;
    const Eigen::Matrix2Xd mine = scaled.middleCols(first, body.points.cols());
    const Eigen::Matrix2d covariance = (body.points.colwise() - body.points.rowwise().mean()) *
                                       (mine.colwise() - mine.rowwise().mean()).transpose();
    sine += covariance(1, 0) - covariance(0, 1);
    cosine += covariance.trace();
  }
  if (known.empty()) return {Eigen::Vector2d::Zero(), std::atan2(sine, cosine)};
  return align_points(Eigen::Matrix2Xd(scaled(Eigen::all, known)),
                      Eigen::Matrix2Xd(positions(Eigen::all, known)));
}

/// Fits every free body to the scaled points; returns the sum of squared residuals.
double place_on(std::vector<RigidBody>& bodies, const Eigen::Matrix2Xd& scaled) {
  const SE2 T_layout_scaled = alignment_to_frame(bodies, scaled);
  double residual = 0;
  for (RigidBody& body : bodies) {
    if (body.points.cols() == 0) continue;
    Eigen::Matrix2Xd wanted =
        T_layout_scaled.rotation_matrix() *
        scaled.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols());
    wanted.colwise() += T_layout_scaled.translation();
    if (!body.fixed) {
      body.T_layout_body = body.sigma_heading_rad > 0
                               ? SE2(wanted.rowwise().mean() - body.points.rowwise().mean(), 0)
                               : align_points(body.points, wanted);
    }
    for (Eigen::Index i = 0; i < body.points.cols(); ++i)
      residual += (body.T_layout_body * Eigen::Vector2d(body.points.col(i)) - wanted.col(i)).squaredNorm();
  }
  return residual;
}

/// Layouts from classical scaling and from its mirror image.
std::vector<std::vector<RigidBody>> starts_by_scaling(const std::vector<RigidBody>& bodies,
                                                      const Eigen::MatrixXd& distances_m) {
  Eigen::Matrix2Xd scaled = classical_scaling(distances_m);
  std::vector<std::vector<RigidBody>> starts(2, bodies);
  place_on(starts[0], scaled);
  scaled.row(1) *= -1;
  place_on(starts[1], scaled);
  return starts;
}

/// Groups do not share a frame.
void drop_pairs_between_groups(PairTargets& targets, const RadioMeasurements& radio,
                               const std::vector<std::size_t>& nodes, const Groups& groups) {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (groups.root(radio.nodes[nodes[i]].robot.index()) !=
          groups.root(radio.nodes[nodes[j]].robot.index()))
        targets.information(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = 0;
}

/// Expresses every group in its own frame: the common one where a pose is known, else its first robot's
/// start.
TeamFrame express_in_group_frames(const KnownStarts& starts, const std::vector<RigidBody>& bodies,
                                  const Groups& groups) {
  TeamFrame frame;
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

/// Layouts fitted to the evidence, from the scaling of its distances and from the mirror image.
std::vector<FieldFit> layouts_by(const LayoutEvidence& evidence, const std::vector<RigidBody>& bodies,
                                 const LayoutParams& params) {
  double farthest = 0;
  for (const double distance : evidence.distances_m.reshaped())
    if (std::isfinite(distance)) farthest = std::max(farthest, distance);
  std::vector<FieldFit> layouts;
  for (auto& start : starts_by_scaling(bodies, evidence.distances_m.cwiseMin(farthest))) {
    const double cost = fit_layout(start, evidence.targets, params.rounds);
    layouts.push_back({std::move(start), FieldModel::nominal(bodies.size()), cost});
  }
  return layouts;
}

bool is_cheaper(const FieldFit& a, const FieldFit& b) { return a.cost < b.cost; }

/// The layout that the radio field fits best after a round, fitted further; without a field, the one that
/// fits the first evidence best.
std::vector<RigidBody> best_layout(const std::vector<RigidBody>& bodies,
                                   const std::vector<LayoutEvidence>& evidence, const TeamField* field,
                                   const LayoutParams& params, const FieldParams& field_params,
                                   const Progress& progress) {
  std::vector<FieldFit> layouts;
  for (const LayoutEvidence& kind : evidence)
    for (FieldFit& layout : layouts_by(kind, bodies, params)) {
      report_progress(progress, "team frame", 0.15 * static_cast<double>(layouts.size()));
      if (field) advance_by_field(layout, *field, field_params, true);
      layouts.push_back(std::move(layout));
    }
  FieldFit best = *std::min_element(layouts.begin(), layouts.end(), is_cheaper);
  for (int round = 1; field && round < field_params.rounds; ++round) {
    report_progress(progress, "team frame", 0.6 + 0.4 * round / field_params.rounds);
    advance_by_field(best, *field, field_params, false);
  }
  return best.bodies;
}

}  // namespace

TeamFrame align_by_fingerprints(const Mission& mission, const KnownStarts& starts,
                                const RadioMeasurements& radio, const LayoutParams& params,
                                const FieldParams& field, const Progress& progress) {
  const Groups groups = group_robots(starts, radio, params);
  const std::vector<std::size_t> nodes = thinned_nodes(radio, params.max_nodes);
  std::vector<RigidBody> bodies = fingerprint_bodies(mission, starts, radio, nodes);
  const bool all_known = std::all_of(bodies.begin(), bodies.end(), [](const auto& b) { return b.fixed; });
  if (radio.layout_model && !all_known) {
    std::vector<LayoutEvidence> evidence = gather_evidence(radio, nodes, bodies, params);
    if (!field.enabled) evidence.resize(1);
    for (LayoutEvidence& kind : evidence) drop_pairs_between_groups(kind.targets, radio, nodes, groups);
    std::optional<TeamField> team_field;
    if (field.enabled) team_field = field_of(radio, nodes, field);
    bodies = best_layout(bodies, evidence, team_field ? &*team_field : nullptr, params, field, progress);
  }
  return express_in_group_frames(starts, bodies, groups);
}

}  // namespace radioslam
