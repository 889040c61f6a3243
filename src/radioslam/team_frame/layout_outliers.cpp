#include "radioslam/team_frame/layout_outliers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kNeighbours = 3;  // other robots that a fingerprint is compared with
constexpr double kNominalDeviations = 3;
constexpr std::size_t kMinTeam = 4;  // robots below which no typical distance is defined

/// Per node, the most similar node of each of the most similar bodies, most similar first. One per body, so
/// that an outlier does not turn its neighbours into outliers.
using Neighbours = std::vector<std::vector<Eigen::Index>>;

Eigen::Index end_of(const RigidBody& body) {
  return static_cast<Eigen::Index>(body.first_node) + body.points.cols();
}

std::vector<Eigen::Index> most_similar(const std::vector<RigidBody>& bodies, const RigidBody& own,
                                       const Eigen::RowVectorXd& similarity) {
  std::vector<std::pair<double, Eigen::Index>> others;
  for (const RigidBody& body : bodies) {
    if (&body == &own || body.points.cols() == 0) continue;
    Eigen::Index best = 0;
    const auto first = static_cast<Eigen::Index>(body.first_node);
    const double most = similarity.segment(first, body.points.cols()).maxCoeff(&best);
    if (most > 0) others.emplace_back(-most, first + best);
  }
  std::sort(others.begin(), others.end());
  others.resize(std::min(kNeighbours, others.size()));
  std::vector<Eigen::Index> nodes;
  for (const auto& other : others) nodes.push_back(other.second);
  return nodes;
}

Neighbours all_neighbours(const std::vector<RigidBody>& bodies, const Eigen::MatrixXd& similarity) {
  Neighbours neighbours(static_cast<std::size_t>(similarity.rows()));
  for (const RigidBody& body : bodies)
    for (auto i = static_cast<Eigen::Index>(body.first_node); i < end_of(body); ++i)
      neighbours[static_cast<std::size_t>(i)] = most_similar(bodies, body, similarity.row(i));
  return neighbours;
}

/// Median distance of the body's nodes to their `rank`-th most similar nodes; nothing if they have none.
std::optional<double> distance_to_ranked(const RigidBody& body, const Neighbours& neighbours,
                                         const Eigen::Matrix2Xd& positions, std::size_t rank) {
  std::vector<double> distances;
  for (auto i = static_cast<Eigen::Index>(body.first_node); i < end_of(body); ++i) {
    const auto& ranked = neighbours[static_cast<std::size_t>(i)];
    if (ranked.empty()) continue;
    const Eigen::Index j = ranked[std::min(rank, ranked.size() - 1)];
    distances.push_back((positions.col(i) - positions.col(j)).norm());
  }
  if (distances.empty()) return std::nullopt;
  return upper_median(std::move(distances));
}

/// Smallest of these medians over all ranks: small for a body whose most similar body is itself an outlier.
double distance_to_similar(const RigidBody& body, const Neighbours& neighbours,
                           const Eigen::Matrix2Xd& positions) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t rank = 0; rank < kNeighbours; ++rank)
    least = std::min(least, distance_to_ranked(body, neighbours, positions, rank).value_or(0));
  return least;
}

/// Translation that minimises the sum of the nodes' distances to the nearest of their most similar nodes.
Eigen::Vector2d best_move(const RigidBody& body, const Neighbours& neighbours,
                          const Eigen::Matrix2Xd& positions) {
  const std::size_t end = body.first_node + static_cast<std::size_t>(body.points.cols());
  const auto apart = [&](std::size_t i, Eigen::Index j) -> Eigen::Vector2d {
    return positions.col(j) - positions.col(static_cast<Eigen::Index>(i));
  };
  const auto sum_after = [&](const Eigen::Vector2d& move) {
    double sum = 0;
    for (std::size_t i = body.first_node; i < end; ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Eigen::Index j : neighbours[i]) nearest = std::min(nearest, (apart(i, j) - move).norm());
      if (!neighbours[i].empty()) sum += nearest;
    }
    return sum;
  };
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  double least = sum_after(best);
  for (std::size_t i = body.first_node; i < end; ++i)
    for (const Eigen::Index j : neighbours[i])
      if (const double sum = sum_after(apart(i, j)); sum < least) {
        least = sum;
        best = apart(i, j);
      }
  return best;
}

}  // namespace

std::vector<std::size_t> relocate_outliers(std::vector<RigidBody>& bodies,
                                           const Eigen::MatrixXd& similarity) {
  const Neighbours neighbours = all_neighbours(bodies, similarity);
  Eigen::Matrix2Xd positions = node_positions(bodies);
  std::vector<double> distances, deviations;
  std::vector<std::pair<double, std::size_t>> layout_outliers;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (const auto distance = distance_to_ranked(bodies[b], neighbours, positions, 0)) {
      distances.push_back(*distance);
      if (!bodies[b].fixed)
        layout_outliers.emplace_back(-distance_to_similar(bodies[b], neighbours, positions), b);
    }
  if (distances.size() < kMinTeam) return {};
  const double typical = upper_median(distances);
  for (const double d : distances) deviations.push_back(std::abs(d - typical));
  const double most = typical + kNominalDeviations * kMadToSigma * upper_median(deviations);
  std::sort(layout_outliers.begin(), layout_outliers.end());

  std::vector<std::size_t> moved;
  for (const auto& [negative_distance, b] : layout_outliers) {
    RigidBody& body = bodies[b];
    if (*distance_to_ranked(body, neighbours, positions, 0) <= most) continue;
    const Eigen::Vector2d move = best_move(body, neighbours, positions);
    if (move.isZero(0)) continue;
    body.T_layout_body = SE2(body.T_layout_body.translation() + move, body.T_layout_body.angle());
    positions.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols()).colwise() += move;
    moved.push_back(b);
  }
  return moved;
}

}  // namespace radioslam
