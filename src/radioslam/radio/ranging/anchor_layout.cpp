#include "radioslam/radio/ranging/anchor_layout.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

// Anchor frame: origin, direction of +x and side of +y for a layout known up to rigid motion and reflection.

using Eigen::Index;

/// Column of the point `wanted` or, by default, of the first whose norm exceeds `bar`; nothing if there is
/// none.
std::optional<Index> off_point(const Eigen::MatrixXd& rows, std::optional<std::size_t> wanted, double bar) {
  for (Index k = 0; k < rows.cols(); ++k) {
    if (wanted && k != static_cast<Index>(*wanted)) continue;
    if (rows.col(k).norm() > bar) return k;
  }
  return std::nullopt;
}

/// Orthogonal matrix whose first row is along `direction`.
Eigen::MatrixXd turn_to_first_axis(const Eigen::VectorXd& direction) {
  const Index d = direction.size();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(d, d);
  basis.col(0) = direction.normalized();
  Index kept = 1;
  for (Index axis = 0; axis < d && kept < d; ++axis) {  // Gram-Schmidt over the axes
    Eigen::VectorXd next = Eigen::VectorXd::Unit(d, axis);
    for (Index k = 0; k < kept; ++k) next -= basis.col(k) * basis.col(k).dot(next);
    constexpr double kIndependent = 0.1;  // at least one axis keeps a larger component
    if (next.norm() > kIndependent) basis.col(kept++) = next.normalized();
  }
  return basis.transpose();
}

/// The points in the frame that these anchors define (anchor_layout.hpp); nothing where the requested anchors
/// are collinear or not distinct. A point counts as off the line (plane) from a distance of `clearance` times
/// the layout's extent.
std::optional<Eigen::MatrixXd> in_anchor_frame(const Eigen::MatrixXd& points, const AnchorFrame& frame,
                                               double clearance) {
  const Index d = points.rows();
  const auto origin = static_cast<Index>(frame.origin.value_or(0));
  Eigen::MatrixXd placed = points.colwise() - points.col(origin);
  const double bar = clearance * placed.colwise().norm().maxCoeff();
  const std::optional<std::size_t> wanted[3] = {frame.along_x, frame.left, std::nullopt};
  for (Index axis = 0; axis < d; ++axis) {
    Eigen::MatrixXd rest = placed.bottomRows(d - axis);
    const auto chosen = off_point(rest, wanted[axis], bar);
    if (!chosen) return std::nullopt;
    placed.bottomRows(d - axis) = turn_to_first_axis(rest.col(*chosen)) * rest;
  }
  return placed;
}

using Eigen::Index;

constexpr double kLooseEigenvalue = 1e-7;      // of J^T J of unit directions: below it a point can move
constexpr double kClearance = 0.02;            // relative to the extent: points beyond it are off a line
constexpr std::size_t kOutlierCandidates = 5;  // distances tried per round of outlier rejection
constexpr double kCheckable = 0.02;            // smallest redundancy of a distance that can be tested

/// Eigenvalues of the information over the coordinates.
struct Spectrum {
  SymmetricEigen<Eigen::MatrixXd> eigen;
  Index free = 0;  ///< number of gauge directions, with the smallest eigenvalues

  Spectrum(const Eigen::MatrixXd& information, Index dimension)
      : eigen(symmetric_eigen(information)), free(dimension * (dimension + 1) / 2) {}

  /// Pseudoinverse without the gauge directions.
  Eigen::MatrixXd covariance() const {
    const Index kept = eigen.values.size() - free;
    const Eigen::MatrixXd vectors = eigen.vectors.rightCols(kept);
    return vectors * eigen.values.tail(kept).cwiseInverse().asDiagonal() * vectors.transpose();
  }
};

std::vector<AnchorDistance> with_unit_sigmas(std::vector<AnchorDistance> distances) {
  for (auto& distance : distances) distance.sigma_m = 1;
  return distances;
}

/// Whether the used distances determine every anchor.
bool is_rigid(const DistanceFit& fit, const std::vector<AnchorDistance>& distances,
              const std::vector<bool>& used) {
  if (fit.redundancy < 0) return false;
  const Spectrum spectrum(distance_information(fit.points, with_unit_sigmas(distances), used),
                          fit.points.rows());
  return spectrum.eigen.values[spectrum.free] > kLooseEigenvalue;
}

std::size_t anchor_with_fewest(std::size_t anchors, const std::vector<AnchorDistance>& distances) {
  std::vector<int> count(anchors);
  for (const auto& distance : distances) ++count[distance.i], ++count[distance.j];
  return static_cast<std::size_t>(std::min_element(count.begin(), count.end()) - count.begin());
}

/// Residuals divided by their own standard deviations; 0 for distances without redundancy.
std::vector<double> standardised(const DistanceFit& fit, const std::vector<AnchorDistance>& distances,
                                 const std::vector<bool>& used) {
  const Index d = fit.points.rows();
  const Eigen::MatrixXd covariance =
      Spectrum(distance_information(fit.points, distances, used), d).covariance();
  const auto residuals = distance_residuals_m(fit.points, distances);
  std::vector<double> result(distances.size());
  for (std::size_t k = 0; k < distances.size(); ++k) {
    if (!used[k]) continue;
    const auto& [i, j, distance_m, sigma_m] = distances[k];
    Eigen::VectorXd row = Eigen::VectorXd::Zero(fit.points.size());
    row.segment(static_cast<Index>(i) * d, d) = direction_between(fit.points, i, j) / sigma_m;
    row.segment(static_cast<Index>(j) * d, d) = -direction_between(fit.points, i, j) / sigma_m;
    const double checked = 1 - row.dot(covariance * row);
    if (checked > kCheckable) result[k] = residuals[k] / sigma_m / std::sqrt(checked);
  }
  return result;
}

/// The distances with the largest standardised residuals.
std::vector<std::size_t> largest_residuals(const std::vector<double>& standardised_residuals) {
  std::vector<std::size_t> order(standardised_residuals.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(standardised_residuals[a]) > std::abs(standardised_residuals[b]);
  });
  order.resize(std::min(order.size(), kOutlierCandidates));
  return order;
}

/// A fit and the distances it uses.
struct Trial {
  DistanceFit fit;
  std::vector<bool> used;
};

/// The best fit with one more distance removed, if the others identify that distance as an outlier.
std::optional<Trial> without_gross_error(const Trial& trial, const std::vector<AnchorDistance>& distances,
                                         const AnchorLayoutParams& params) {
  constexpr std::ptrdiff_t kMinRedundancy = 2;
  if (trial.fit.redundancy <= kMinRedundancy) return std::nullopt;
  std::optional<Trial> best;
  for (const std::size_t k : largest_residuals(standardised(trial.fit, distances, trial.used))) {
    Trial next{{}, trial.used};
    next.used[k] = false;
    next.fit = fit_distances(static_cast<std::size_t>(trial.fit.points.cols()), params.dimension, distances,
                             next.used);
    if (!is_rigid(next.fit, distances, next.used)) continue;
    if (!best || next.fit.chi_squared < best->fit.chi_squared) best = next;
  }
  if (!best) return std::nullopt;
  // The decrease of chi-squared is the square of the deletion residual.
  const double deletion = std::sqrt(std::max(0.0, trial.fit.chi_squared - best->fit.chi_squared));
  // With little redundancy the noise estimate is uncertain: inflation as of Student's t.
  constexpr double kStudent = 4;
  const double inflation = 1 + kStudent / static_cast<double>(best->fit.redundancy);
  const double noise = std::max(1.0, best->fit.noise_factor() * inflation);
  if (deletion <= params.outlier_sigmas * noise) return std::nullopt;
  return best;
}

/// Whether a layout of one dimension less explains the distances nearly as well.
bool is_flat(const Trial& trial, const std::vector<AnchorDistance>& distances,
             const AnchorLayoutParams& params) {
  const auto flat = fit_distances(static_cast<std::size_t>(trial.fit.points.cols()), params.dimension - 1,
                                  distances, trial.used);
  const double noise = std::max(1.0, trial.fit.noise_factor());
  return flat.chi_squared - trial.fit.chi_squared < std::pow(params.flatness_sigmas * noise, 2);
}

AnchorLayout layout_of(const Trial& trial, const Eigen::MatrixXd& placed,
                       const std::vector<AnchorDistance>& distances) {
  AnchorLayout layout;
  layout.positions_m = Eigen::Matrix3Xd::Zero(3, placed.cols());
  layout.positions_m.topRows(placed.rows()) = placed;
  layout.residuals_m = distance_residuals_m(placed, distances);
  layout.used = trial.used;
  layout.redundancy = trial.fit.redundancy;
  layout.noise_factor = trial.fit.noise_factor();
  const Eigen::VectorXd variances =
      Spectrum(distance_information(placed, distances, trial.used), placed.rows()).covariance().diagonal();
  const double noise = std::max(1.0, layout.noise_factor);
  for (Index k = 0; k < placed.cols(); ++k)
    layout.sigmas_m.push_back(noise * std::sqrt(variances.segment(k * placed.rows(), placed.rows()).mean()));
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < distances.size(); ++k)
    if (trial.used[k]) sum += layout.residuals_m[k] * layout.residuals_m[k], ++count;
  layout.rms_m = std::sqrt(sum / count);
  return layout;
}

}  // namespace

std::variant<AnchorLayout, LayoutFailure> estimate_anchor_layout(std::size_t anchors,
                                                                 const std::vector<AnchorDistance>& distances,
                                                                 const AnchorFrame& frame,
                                                                 const AnchorLayoutParams& params) {
  for (const auto& distance : distances)
    RADIOSLAM_CHECK(distance.sigma_m > 0, "the sigma of a distance is positive");
  if (anchors <= static_cast<std::size_t>(params.dimension))
    return LayoutFailure{LayoutRefusal::kTooFewAnchors, 0};
  const auto connected = connected_to_first(anchors, distances);
  if (const auto disconnected = std::find(connected.begin(), connected.end(), false);
      disconnected != connected.end())
    return LayoutFailure{LayoutRefusal::kDisconnected,
                         static_cast<std::size_t>(disconnected - connected.begin())};

  Trial trial{{}, std::vector<bool>(distances.size(), true)};
  trial.fit = fit_distances(anchors, params.dimension, distances, trial.used);
  if (trial.fit.redundancy < 0)
    return LayoutFailure{LayoutRefusal::kPoorlyConstrained, anchor_with_fewest(anchors, distances)};
  if (is_flat(trial, distances, params)) return LayoutFailure{LayoutRefusal::kFlat, 0};
  if (!is_rigid(trial.fit, distances, trial.used))
    return LayoutFailure{LayoutRefusal::kPoorlyConstrained, anchor_with_fewest(anchors, distances)};
  while (auto next = without_gross_error(trial, distances, params)) trial = std::move(*next);
  const auto placed = in_anchor_frame(trial.fit.points, frame, kClearance);
  if (!placed) return LayoutFailure{LayoutRefusal::kFrame, 0};
  return layout_of(trial, *placed, distances);
}

}  // namespace radioslam
