#include "radioslam/team_frame/strays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "radioslam/base/median.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMostAlike = 3;  // robots that a scan is compared with, one scan of each
constexpr double kUsualDeviations = 3;
constexpr double kMadOfGaussian = 1.4826;  // standard deviation over median absolute deviation
constexpr std::size_t kLeastTeam = 4;      // robots below which nothing is usual

/// Per node the most similar node of each of the bodies that are most like it, the most alike first: of one
/// body only one, so that a stray does not make strays of its neighbours.
using Neighbours = std::vector<std::vector<Eigen::Index>>;

Eigen::Index end_of(const RigidBody& body) {
  return static_cast<Eigen::Index>(body.first_node) + body.points.cols();
}

std::vector<Eigen::Index> most_alike(const std::vector<RigidBody>& bodies, const RigidBody& own,
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
  others.resize(std::min(kMostAlike, others.size()));
  std::vector<Eigen::Index> nodes;
  for (const auto& other : others) nodes.push_back(other.second);
  return nodes;
}

Neighbours all_neighbours(const std::vector<RigidBody>& bodies, const Eigen::MatrixXd& similarity) {
  Neighbours neighbours(static_cast<std::size_t>(similarity.rows()));
  for (const RigidBody& body : bodies)
    for (auto i = static_cast<Eigen::Index>(body.first_node); i < end_of(body); ++i)
      neighbours[static_cast<std::size_t>(i)] = most_alike(bodies, body, similarity.row(i));
  return neighbours;
}

/// The median over the body's nodes of the distance to their `rank`-th most similar ones; nothing where they
/// have none.
std::optional<double> distance_to_alike(const RigidBody& body, const Neighbours& neighbours,
                                        const Eigen::Matrix2Xd& positions, std::size_t rank) {
  std::vector<double> distances;
  for (auto i = static_cast<Eigen::Index>(body.first_node); i < end_of(body); ++i) {
    const auto& alike = neighbours[static_cast<std::size_t>(i)];
    if (alike.empty()) continue;
    const Eigen::Index j = alike[std::min(rank, alike.size() - 1)];
    distances.push_back((positions.col(i) - positions.col(j)).norm());
  }
  if (distances.empty()) return std::nullopt;
  return upper_median(std::move(distances));
}

/// How far the body is from all that are like it: small for one that only its nearest, a stray, left alone.
double loneliness(const RigidBody& body, const Neighbours& neighbours, const Eigen::Matrix2Xd& positions) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t rank = 0; rank < kMostAlike; ++rank)
    least = std::min(least, distance_to_alike(body, neighbours, positions, rank).value_or(0));
  return least;
}

/// The move after which the nodes' distances to the nearest of their most similar ones sum to the least.
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

std::vector<std::size_t> relocate_strays(std::vector<RigidBody>& bodies, const Eigen::MatrixXd& similarity) {
  const Neighbours neighbours = all_neighbours(bodies, similarity);
  Eigen::Matrix2Xd positions = node_positions(bodies);
  std::vector<double> distances, deviations;
  std::vector<std::pair<double, std::size_t>> strays;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (const auto distance = distance_to_alike(bodies[b], neighbours, positions, 0)) {
      distances.push_back(*distance);
      if (!bodies[b].fixed) strays.emplace_back(-loneliness(bodies[b], neighbours, positions), b);
    }
  if (distances.size() < kLeastTeam) return {};
  const double usual = upper_median(distances);
  for (const double d : distances) deviations.push_back(std::abs(d - usual));
  const double most = usual + kUsualDeviations * kMadOfGaussian * upper_median(deviations);
  std::sort(strays.begin(), strays.end());

  std::vector<std::size_t> moved;
  for (const auto& [lonely, b] : strays) {
    RigidBody& body = bodies[b];
    if (*distance_to_alike(body, neighbours, positions, 0) <= most) continue;
    const Eigen::Vector2d move = best_move(body, neighbours, positions);
    if (move.isZero(0)) continue;
    body.T_layout_body = SE2(body.T_layout_body.translation() + move, body.T_layout_body.angle());
    positions.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols()).colwise() += move;
    moved.push_back(b);
  }
  return moved;
}

}  // namespace radioslam
