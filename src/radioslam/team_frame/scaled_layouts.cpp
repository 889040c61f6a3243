#include "radioslam/team_frame/scaled_layouts.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
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

}  // namespace

std::vector<Layout> scaled_layouts(const LayoutEvidence& evidence, const std::vector<RigidBody>& bodies,
                                   const LayoutParams& params) {
  double farthest = 0;
  for (const double distance : evidence.distances_m.reshaped())
    if (std::isfinite(distance)) farthest = std::max(farthest, distance);
  std::vector<Layout> layouts;
  for (auto& start : starts_by_scaling(bodies, evidence.distances_m.cwiseMin(farthest))) {
    const double cost = fit_layout(start, evidence.targets, params.rounds);
    layouts.push_back({std::move(start), cost});
  }
  return layouts;
}

}  // namespace radioslam
