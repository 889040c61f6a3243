#include "radioslam/team_frame/strays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace radioslam {
namespace {

constexpr std::size_t kMostAlike = 3;  // scans of others that a scan is compared with
constexpr double kUsualDeviations = 3;
constexpr double kMadOfGaussian = 1.4826;  // standard deviation over median absolute deviation
constexpr std::size_t kLeastTeam = 4;      // robots below which nothing is usual

/// Per node its most similar nodes of other bodies, the most alike first.
using Neighbours = std::vector<std::vector<Eigen::Index>>;

Neighbours most_alike(const std::vector<RigidBody>& bodies, const Eigen::MatrixXd& similarity) {
  Neighbours neighbours(static_cast<std::size_t>(similarity.rows()));
  for (const RigidBody& body : bodies) {
    const auto first = static_cast<Eigen::Index>(body.first_node), end = first + body.points.cols();
    for (Eigen::Index i = first; i < end; ++i) {
      std::vector<std::pair<double, Eigen::Index>> others;
      for (Eigen::Index j = 0; j < similarity.cols(); ++j)
        if ((j < first || j >= end) && similarity(i, j) > 0) others.emplace_back(-similarity(i, j), j);
      const std::size_t kept = std::min(kMostAlike, others.size());
      std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(kept), others.end());
      for (std::size_t k = 0; k < kept; ++k)
        neighbours[static_cast<std::size_t>(i)].push_back(others[k].second);
    }
  }
  return neighbours;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The median distance of the body's nodes to their most similar ones; nothing where they have none.
std::optional<double> distance_to_alike(const RigidBody& body, const Neighbours& neighbours,
                                        const Eigen::Matrix2Xd& positions) {
  std::vector<double> distances;
  for (std::size_t i = body.first_node; i < body.first_node + static_cast<std::size_t>(body.points.cols());
       ++i)
    if (!neighbours[i].empty())
      distances.push_back(
          (positions.col(static_cast<Eigen::Index>(i)) - positions.col(neighbours[i].front())).norm());
  if (distances.empty()) return std::nullopt;
  return median(std::move(distances));
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
  const Neighbours neighbours = most_alike(bodies, similarity);
  Eigen::Matrix2Xd positions = node_positions(bodies);
  std::vector<double> distances, deviations;
  std::vector<std::pair<double, std::size_t>> strays;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (const auto distance = distance_to_alike(bodies[b], neighbours, positions)) {
      distances.push_back(*distance);
      if (!bodies[b].fixed) strays.emplace_back(-*distance, b);
    }
  if (distances.size() < kLeastTeam) return {};
  const double usual = median(distances);
  for (const double d : distances) deviations.push_back(std::abs(d - usual));
  const double most = usual + kUsualDeviations * kMadOfGaussian * median(deviations);
  std::erase_if(strays, [most](const auto& stray) { return -stray.first <= most; });
  std::sort(strays.begin(), strays.end());

  std::vector<std::size_t> moved;
  for (const auto& [distance, b] : strays) {
    RigidBody& body = bodies[b];
    const Eigen::Vector2d move = best_move(body, neighbours, positions);
    if (move.isZero(0)) continue;
    body.T_layout_body = SE2(body.T_layout_body.translation() + move, body.T_layout_body.angle());
    positions.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols()).colwise() += move;
    moved.push_back(b);
  }
  return moved;
}

}  // namespace radioslam
