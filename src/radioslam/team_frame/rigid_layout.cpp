#include "radioslam/team_frame/rigid_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

constexpr double kStill_m = 0.01;
constexpr int kSweepsPerRound = 5;
constexpr double kMinGain = 3e-4;     // of the cost
constexpr double kTogether_m = 1e-9;  // below this distance the direction between two points is undefined

Eigen::Matrix2Xd placed_points(const RigidBody& body) {
  Eigen::Matrix2Xd placed = body.T_layout_body.rotation_matrix() * body.points;
  placed.colwise() += body.T_layout_body.translation();
  return placed;
}

/// Target position of each point of a body (Guttman transform) and its weight.
struct Pull {
  Eigen::Matrix2Xd wanted;
  Eigen::VectorXd weight;
};

Pull pull_on(const RigidBody& body, const Eigen::Matrix2Xd& positions, const PairTargets& targets) {
  const Eigen::Index count = body.points.cols();
  const auto first = static_cast<Eigen::Index>(body.first_node);
  Pull pull{Eigen::Matrix2Xd::Zero(2, count), Eigen::VectorXd::Zero(count)};
  parallel_for(static_cast<std::size_t>(count), 4, [&](std::size_t begin, std::size_t end) {
    for (auto k = static_cast<Eigen::Index>(begin); k < static_cast<Eigen::Index>(end); ++k) {
      const Eigen::Index i = first + k;
      for (Eigen::Index j = 0; j < positions.cols(); ++j) {
        if (j >= first && j < first + count) continue;
        const Eigen::Vector2d apart = positions.col(i) - positions.col(j);
        const double distance = apart.norm(), target = static_cast<double>(targets.distance_m(j, i));
        const double weight = static_cast<double>(targets.weight(j, i) * targets.information(j, i));
        if (weight <= 0) continue;
        const Eigen::Vector2d direction =
            distance > kTogether_m ? Eigen::Vector2d(apart / distance) : Eigen::Vector2d::UnitX();
        pull.wanted.col(k) += weight * (positions.col(j) + target * direction);
        pull.weight[k] += weight;
      }
      if (pull.weight[k] > 0) pull.wanted.col(k) /= pull.weight[k];
    }
  });
  return pull;
}

/// Rigid motion that fits the targets best, with the heading prior if there is one.
SE2 fit_to_pull(const RigidBody& body, const Pull& pull, double common_heading_rad) {
  const double total = pull.weight.sum();
  if (total <= 0) return body.T_layout_body;
  const Eigen::Vector2d point_mean = body.points * pull.weight / total;
  const Eigen::Vector2d wanted_mean = pull.wanted * pull.weight / total;
  const Eigen::Matrix2d covariance = (pull.wanted.colwise() - wanted_mean) * pull.weight.asDiagonal() *
                                     (body.points.colwise() - point_mean).transpose();
  double sine = covariance(1, 0) - covariance(0, 1), cosine = covariance.trace();
  if (body.sigma_heading_rad > 0) {
    const double information = 1 / (body.sigma_heading_rad * body.sigma_heading_rad);
    sine += information * std::sin(common_heading_rad);
    cosine += information * std::cos(common_heading_rad);
  }
  const SE2 rotation(Eigen::Vector2d::Zero(), std::atan2(sine, cosine));
  return {wanted_mean - rotation.rotate(point_mean), rotation.angle()};
}

double common_heading(const std::vector<RigidBody>& bodies) {
  double sine = 0, cosine = 0;
  for (const RigidBody& body : bodies) {
    if (body.sigma_heading_rad <= 0) continue;
    sine += std::sin(body.T_layout_body.angle());
    cosine += std::cos(body.T_layout_body.angle());
  }
  return std::atan2(sine, cosine);
}

}  // namespace

Eigen::Matrix2Xd node_positions(const std::vector<RigidBody>& bodies) {
  Eigen::Index nodes = 0;
  for (const RigidBody& body : bodies) nodes += body.points.cols();
  Eigen::Matrix2Xd positions(2, nodes);
  for (const RigidBody& body : bodies)
    positions.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols()) =
        placed_points(body);
  return positions;
}

void majorise_stress(std::vector<RigidBody>& bodies, const PairTargets& targets, int sweeps) {
  Eigen::Matrix2Xd positions = node_positions(bodies);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    double moved = 0;
    const double heading = common_heading(bodies);
    for (RigidBody& body : bodies) {
      if (body.fixed || body.points.cols() == 0) continue;
      body.T_layout_body = fit_to_pull(body, pull_on(body, positions, targets), heading);
      auto mine = positions.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols());
      const Eigen::Matrix2Xd placed = placed_points(body);
      moved = std::max(moved, (placed - mine).colwise().norm().maxCoeff());
      mine = placed;
    }
    if (moved < kStill_m) return;
  }
}

namespace {

/// Squared residual of a pair over its variance; 0 without evidence.
double squared_residual(const Eigen::Matrix2Xd& positions, const PairTargets& targets, Eigen::Index i,
                        Eigen::Index j) {
  const double off =
      (positions.col(i) - positions.col(j)).norm() - static_cast<double>(targets.distance_m(i, j));
  return off * off * static_cast<double>(targets.information(i, j));
}

/// The targets with Cauchy weights at the bodies' present positions.
void renew_weights(const Eigen::Matrix2Xd& positions, const PairTargets& targets, PairTargets& renewed) {
  const Eigen::Index n = positions.cols();
  parallel_for(static_cast<std::size_t>(n), 16, [&](std::size_t begin, std::size_t end) {
    for (auto j = static_cast<Eigen::Index>(begin); j < static_cast<Eigen::Index>(end); ++j)
      for (Eigen::Index i = 0; i < n; ++i)
        renewed.weight(i, j) = static_cast<float>(static_cast<double>(targets.weight(i, j)) /
                                                  (1 + squared_residual(positions, targets, i, j)));
  });
}

}  // namespace

double layout_cost(const std::vector<RigidBody>& bodies, const PairTargets& targets) {
  const Eigen::Matrix2Xd positions = node_positions(bodies);
  const Eigen::Index n = positions.cols();
  std::vector<double> of_node(static_cast<std::size_t>(n), 0);
  parallel_for(of_node.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(j); ++i)
        of_node[j] += static_cast<double>(targets.weight(i, static_cast<Eigen::Index>(j))) *
                      std::log1p(squared_residual(positions, targets, i, static_cast<Eigen::Index>(j))) / 2;
  });
  double cost = std::accumulate(of_node.begin(), of_node.end(), 0.0);
  const double heading = common_heading(bodies);
  for (const RigidBody& body : bodies)
    if (body.sigma_heading_rad > 0)
      cost += (1 - std::cos(body.T_layout_body.angle() - heading)) /
              (body.sigma_heading_rad * body.sigma_heading_rad);
  return cost;
}

double fit_layout(std::vector<RigidBody>& bodies, const PairTargets& targets, int rounds) {
  PairTargets renewed = targets;
  double cost = layout_cost(bodies, targets);
  for (int round = 0; round < rounds; ++round) {
    renew_weights(node_positions(bodies), targets, renewed);
    majorise_stress(bodies, renewed, kSweepsPerRound);
    const double before = cost;
    cost = layout_cost(bodies, targets);
    if (before - cost < kMinGain * cost) break;
  }
  return cost;
}

}  // namespace radioslam
