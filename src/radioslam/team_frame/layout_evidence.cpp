#include "radioslam/team_frame/layout_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

std::size_t end_of(const RigidBody& body) {
  return body.first_node + static_cast<std::size_t>(body.points.cols());
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
std::vector<std::vector<std::size_t>> similar_nodes(const NodeSimilarity& similarity,
                                                    const std::vector<std::size_t>& body_of,
                                                    std::size_t most) {
  std::vector<std::vector<std::size_t>> similar(body_of.size());
  parallel_for(body_of.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<std::pair<double, std::size_t>> others;
      for (std::size_t j = 0; j < body_of.size(); ++j) {
        if (body_of[i] == body_of[j]) continue;
        const double s = similarity(i, j);
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

/// Predicted distances to each node's most similar ones, and odometry within robots of known relative pose.
FingerprintGraph connect(const NodeSimilarity& similarity,
                         const std::vector<std::vector<std::size_t>>& similar,
                         const std::vector<RigidBody>& bodies, const PredictDistance& predict_m,
                         Eigen::MatrixXf& predicted_m) {
  FingerprintGraph graph(similar.size());
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
  for (std::size_t i = 0; i < similar.size(); ++i)
    for (const std::size_t j : similar[i]) {
      const double distance = predict_m(similarity(i, j));
      graph.connect(i, j, distance);
      const auto p = static_cast<Eigen::Index>(i), q = static_cast<Eigen::Index>(j);
      predicted_m(p, q) = predicted_m(q, p) = static_cast<float>(distance);
    }
  return graph;
}

/// Paths through the graph; predicted distances of similar nodes as they are.
LayoutEvidence evidence_of_paths(const NodeSimilarity& similarity,
                                 const std::vector<std::vector<std::size_t>>& similar,
                                 const std::vector<std::size_t>& body_of,
                                 const std::vector<RigidBody>& bodies, const PredictDistance& predict_m,
                                 const LayoutParams& params) {
  const auto n = static_cast<Eigen::Index>(body_of.size());
  Eigen::MatrixXf predicted_m = Eigen::MatrixXf::Constant(n, n, -1);
  LayoutEvidence evidence{connect(similarity, similar, bodies, predict_m, predicted_m).shortest_paths(),
                          {Eigen::MatrixXf::Zero(n, n), Eigen::MatrixXf::Zero(n, n),
                           Eigen::MatrixXf::Constant(n, n, static_cast<float>(params.pair_weight))}};
  PairTargets& targets = evidence.targets;
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double distance = evidence.distances_m(i, j);
      if (!std::isfinite(distance) ||
          body_of[static_cast<std::size_t>(i)] == body_of[static_cast<std::size_t>(j)])
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

}  // namespace

std::vector<LayoutEvidence> gather_evidence(const RadioMeasurements& radio, const NodeSimilarity& similarity,
                                            const std::vector<RigidBody>& bodies,
                                            const LayoutParams& params) {
  std::vector<std::size_t> body_of;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    body_of.insert(body_of.end(), static_cast<std::size_t>(bodies[b].points.cols()), b);
  const auto similar = similar_nodes(similarity, body_of, static_cast<std::size_t>(params.neighbours));
  std::vector<LayoutEvidence> evidence;
  const auto add = [&](const auto& model) {
    evidence.push_back(evidence_of_paths(
        similarity, similar, body_of, bodies, [&](double s) { return model.distance_m(s); }, params));
  };
  add(*radio.layout_model);
  if (radio.decay_model) add(*radio.decay_model);
  return evidence;
}

}  // namespace radioslam
