#include "radioslam/radio/ranging/multilateration.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

using Eigen::Index;

constexpr int kMaxSteps = 30;
constexpr double kSettled_m = 1e-9;
constexpr double kFlat = 0.01;  // rank tolerance, relative to the anchors' spread

bool enough_anchors(const std::vector<RangeToAnchor>& sights, Index dimension) {
  std::vector<std::size_t> anchors;
  for (const auto& sight : sights) anchors.push_back(sight.anchor);
  std::sort(anchors.begin(), anchors.end());
  return std::unique(anchors.begin(), anchors.end()) - anchors.begin() > dimension;
}

/// Solution of the linear equations; nothing where the anchors are collinear (coplanar).
std::optional<SmallVector> linear_start(const Eigen::MatrixXd& anchors,
                                        const std::vector<RangeToAnchor>& sights) {
  const auto& reference = *std::min_element(
      sights.begin(), sights.end(), [](const auto& a, const auto& b) { return a.range_m < b.range_m; });
  const Eigen::VectorXd origin = anchors.col(static_cast<Index>(reference.anchor));
  Eigen::MatrixXd rows(sights.size(), anchors.rows());
  Eigen::VectorXd right(sights.size());
  for (std::size_t k = 0; k < sights.size(); ++k) {
    const Eigen::VectorXd from_origin = anchors.col(static_cast<Index>(sights[k].anchor)) - origin;
    rows.row(static_cast<Index>(k)) = 2 * from_origin.transpose();
    right[static_cast<Index>(k)] = reference.range_m * reference.range_m -
                                   sights[k].range_m * sights[k].range_m + from_origin.squaredNorm();
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(kFlat);
  qr.compute(rows);
  if (qr.rank() < anchors.rows()) return std::nullopt;
  return SmallVector(origin + qr.solve(right));
}

double cauchy_weight(double normalised, double scale) {
  return 1 / (1 + normalised * normalised / (scale * scale));
}

/// Normal equations at a position, with residuals and robust weights.
struct Normal {
  SmallMatrix information;
  SmallVector pull;
  std::vector<double> residuals, weights;
};

Normal normal_at(const SmallVector& position, const Eigen::MatrixXd& anchors,
                 const std::vector<RangeToAnchor>& sights, double loss_sigmas) {
  const Index d = anchors.rows();
  const bool redundant = sights.size() > static_cast<std::size_t>(d);
  Normal normal{SmallMatrix::Zero(d, d), SmallVector::Zero(d), {}, {}};
  for (const auto& [anchor, range_m, sigma_m] : sights) {
    const SmallVector away = position - anchors.col(static_cast<Index>(anchor));
    const double distance = away.norm(), residual = distance - range_m;
    const double weight = redundant ? cauchy_weight(residual / sigma_m, loss_sigmas) : 1;
    normal.residuals.push_back(residual);
    normal.weights.push_back(weight);
    if (distance == 0) continue;  // the gradient is undefined at the anchor
    const SmallVector u = away / distance;
    normal.information += weight / (sigma_m * sigma_m) * u * u.transpose();
    normal.pull -= weight / (sigma_m * sigma_m) * residual * u;
  }
  return normal;
}

}  // namespace

std::optional<Multilateration> multilaterate(const Eigen::MatrixXd& anchors_m,
                                             const std::vector<RangeToAnchor>& sights,
                                             const MultilaterationParams& params) {
  if (!enough_anchors(sights, anchors_m.rows())) return std::nullopt;
  auto position = linear_start(anchors_m, sights);
  if (!position) return std::nullopt;
  Normal normal;
  for (int step = 0; step < kMaxSteps; ++step) {
    normal = normal_at(*position, anchors_m, sights, params.loss_sigmas);
    const SmallVector move = ldlt_solve(normal.information, normal.pull);
    if (!move.allFinite()) return std::nullopt;
    *position += move;
    if (move.norm() < kSettled_m) break;
  }
  normal = normal_at(*position, anchors_m, sights, params.loss_sigmas);
  const Index d = anchors_m.rows();
  const SmallMatrix covariance = ldlt_solve_matrix(normal.information, SmallMatrix::Identity(d, d));
  const double sigma_m = std::sqrt(covariance.trace() / static_cast<double>(d));
  if (!(sigma_m <= params.max_sigma_m)) return std::nullopt;
  return Multilateration{*position, covariance, sigma_m, std::move(normal.residuals),
                         std::move(normal.weights)};
}

}  // namespace radioslam
