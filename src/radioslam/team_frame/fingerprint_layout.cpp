#include "radioslam/team_frame/fingerprint_layout.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/radio/fingerprints/shared_access_points.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {
namespace {

/// T_common_start of a robot whose first body pose is known.
SE2 start_from_initial_pose(const SE3& initial_pose, const Robot& robot) {
  return flatten(initial_pose) * flatten(robot.odometry.front().pose).inverse();
}

}  // namespace

std::vector<std::size_t> thinned_nodes(std::size_t count, int most) {
  const auto kept = static_cast<std::size_t>(most);
  const std::size_t stride = std::max<std::size_t>(1, (count + kept - 1) / kept);
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < count; i += stride) nodes.push_back(i);
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

PairTargets make_targets(const RadioMeasurements& radio, const std::vector<std::size_t>& nodes,
                         const LayoutParams& params) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  PairTargets targets{Eigen::MatrixXf::Zero(n, n), Eigen::MatrixXf::Zero(n, n),
                      Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>::Constant(n, n, false)};
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const std::size_t a = nodes[static_cast<std::size_t>(i)], b = nodes[static_cast<std::size_t>(j)];
      if (radio.nodes[a].robot == radio.nodes[b].robot) continue;
      const double s = static_cast<double>(radio.layout_similarity.of(a, b));
      const double distance = radio.layout_model->distance_m(std::max(s, params.min_similarity));
      const double sigma2 = params.sigma_m * params.sigma_m +
                            params.sigma_relative * params.sigma_relative * distance * distance;
      targets.distance_m(i, j) = static_cast<float>(distance);
      targets.weight(i, j) = static_cast<float>(params.pair_weight / sigma2);
      targets.lower_bound(i, j) = s <= params.min_similarity;
    }
  return targets;
}

/// Distances for the scaling: odometry within a robot, known positions between fixed ones, radio elsewhere.
Eigen::MatrixXd scaling_distances(const std::vector<RigidBody>& bodies, const PairTargets& targets) {
  Eigen::MatrixXd distances = targets.distance_m.cast<double>();
  const Eigen::Matrix2Xd positions = node_positions(bodies);
  for (const RigidBody& a : bodies)
    for (const RigidBody& b : bodies) {
      if (&a != &b && !(a.fixed && b.fixed)) continue;
      for (Eigen::Index i = 0; i < a.points.cols(); ++i)
        for (Eigen::Index j = 0; j < b.points.cols(); ++j) {
          const Eigen::Index p = static_cast<Eigen::Index>(a.first_node) + i;
          const Eigen::Index q = static_cast<Eigen::Index>(b.first_node) + j;
          distances(p, q) = (positions.col(p) - positions.col(q)).norm();
        }
    }
  return distances;
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

/// Layouts from classical scaling, with distances cut at `cap_m`, and from its mirror image.
std::vector<std::vector<RigidBody>> starts_by_scaling(const std::vector<RigidBody>& bodies,
                                                      const PairTargets& targets, double cap_m) {
  Eigen::Matrix2Xd scaled = classical_scaling(scaling_distances(bodies, targets).cwiseMin(cap_m));
  std::vector<std::vector<RigidBody>> starts(2, bodies);
  place_on(starts[0], scaled);
  scaled.row(1) *= -1;
  place_on(starts[1], scaled);
  return starts;
}

/// Between groups there are lower bounds at most; these are left out.
void drop_pairs_between_groups(PairTargets& targets, const RadioMeasurements& radio,
                               const std::vector<std::size_t>& nodes, const Groups& groups) {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (groups.root(radio.nodes[nodes[i]].robot.index()) !=
          groups.root(radio.nodes[nodes[j]].robot.index()))
        targets.weight(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = 0;
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

/// Majorises from several initial layouts and keeps the one of least stress: the cut-off distance that serves
/// the scaling best differs between buildings, and either mirror image may fit.
std::vector<RigidBody> best_layout(const std::vector<RigidBody>& bodies, const PairTargets& targets,
                                   const DecayModel& model, const LayoutParams& params,
                                   const Progress& progress) {
  constexpr std::array kCapSimilarities = {0.05, 0.1, 0.2, 0.3};
  std::vector<RigidBody> best;
  double min_stress = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < kCapSimilarities.size(); ++c) {
    report_progress(progress, "team frame", static_cast<double>(c) / kCapSimilarities.size());
    for (auto& start : starts_by_scaling(bodies, targets, model.distance_m(kCapSimilarities[c]))) {
      majorise_stress(start, targets, params.sweeps);
      const double stress = layout_stress(start, targets);
      if (stress >= min_stress) continue;
      min_stress = stress;
      best = std::move(start);
    }
  }
  return best;
}

}  // namespace

TeamFrame align_by_fingerprints(const Mission& mission, const KnownStarts& starts,
                                const RadioMeasurements& radio, const LayoutParams& params,
                                const Progress& progress) {
  const Groups groups = group_robots(starts, radio, params);
  const std::vector<std::size_t> nodes = thinned_nodes(radio.nodes.size(), params.max_nodes);
  std::vector<RigidBody> bodies = fingerprint_bodies(mission, starts, radio, nodes);
  const bool all_known = std::all_of(bodies.begin(), bodies.end(), [](const auto& b) { return b.fixed; });
  if (radio.layout_model && !all_known) {
    PairTargets targets = make_targets(radio, nodes, params);
    drop_pairs_between_groups(targets, radio, nodes, groups);
    bodies = best_layout(bodies, targets, *radio.layout_model, params, progress);
  }
  return express_in_group_frames(starts, bodies, groups);
}

}  // namespace radioslam
