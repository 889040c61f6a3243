#include "radioslam/team_frame/rigid_layout.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

constexpr double kStill_m = 0.01;
constexpr double kTogether_m = 1e-9;  // below this distance the direction between two points is undefined

Eigen::Matrix2Xd placed_points(const RigidBody& body) {
  Eigen::Matrix2Xd placed = body.T_layout_body.rotation_matrix() * body.points;
  placed.colwise() += body.T_layout_body.translation();
  return placed;
}

bool exerts_no_pull(float weight, bool lower_bound, double distance, double target) {
  return weight <= 0 || (lower_bound && distance >= target);
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
        const double weight = static_cast<double>(targets.weight(j, i));
        if (exerts_no_pull(targets.weight(j, i), targets.lower_bound(j, i), distance, target)) continue;
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

double layout_stress(const std::vector<RigidBody>& bodies, const PairTargets& targets) {
  const Eigen::Matrix2Xd positions = node_positions(bodies);
  double stress = 0;
  for (const RigidBody& body : bodies) {
    const auto first = static_cast<Eigen::Index>(body.first_node);
    for (Eigen::Index i = first; i < first + body.points.cols(); ++i)
      for (Eigen::Index j = 0; j < first; ++j) {
        const double distance = (positions.col(i) - positions.col(j)).norm();
        const double target = static_cast<double>(targets.distance_m(j, i));
        if (exerts_no_pull(targets.weight(j, i), targets.lower_bound(j, i), distance, target)) continue;
        stress += static_cast<double>(targets.weight(j, i)) * (distance - target) * (distance - target);
      }
  }
  return stress;
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

}  // namespace radioslam
