#include "radioslam/radio/anchor_layout.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/radio/anchor_frame.hpp"

namespace radioslam {
namespace {

using Eigen::Index;

constexpr double kLooseEigenvalue = 1e-7;  // of J^T J of unit directions: below, a point can move
constexpr double kClearance = 0.02;        // of the extent: further off a line than this is off it
constexpr std::size_t kSuspects = 5;       // distances tried per round of setting aside
constexpr double kCheckable = 0.02;        // share of a distance that others check; below, none judges it

/// The directions in which the coordinates are determined, by eigenvalues of the information.
struct Spectrum {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  Index free = 0;  ///< how many eigenvalues are those of shift and turn, the lowest ones

  Spectrum(const Eigen::MatrixXd& information, Index dimension)
      : eigen(information), free(dimension * (dimension + 1) / 2) {}

  /// Inverse without shift and turn.
  Eigen::MatrixXd covariance() const {
    const Index kept = eigen.eigenvalues().size() - free;
    const Eigen::MatrixXd vectors = eigen.eigenvectors().rightCols(kept);
    return vectors * eigen.eigenvalues().tail(kept).cwiseInverse().asDiagonal() * vectors.transpose();
  }
};

std::vector<AnchorDistance> with_unit_sigmas(std::vector<AnchorDistance> distances) {
  for (auto& distance : distances) distance.sigma_m = 1;
  return distances;
}

/// Whether the distances used hold every anchor in place.
bool is_rigid(const DistanceFit& fit, const std::vector<AnchorDistance>& distances,
              const std::vector<bool>& used) {
  if (fit.redundancy < 0) return false;
  const Spectrum spectrum(distance_information(fit.points, with_unit_sigmas(distances), used),
                          fit.points.rows());
  return spectrum.eigen.eigenvalues()[spectrum.free] > kLooseEigenvalue;
}

std::size_t anchor_with_fewest(std::size_t anchors, const std::vector<AnchorDistance>& distances) {
  std::vector<int> count(anchors);
  for (const auto& distance : distances) ++count[distance.i], ++count[distance.j];
  return static_cast<std::size_t>(std::min_element(count.begin(), count.end()) - count.begin());
}

/// Residuals over their own standard deviations; 0 for those that no other distance checks.
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

/// The distances whose residuals stand out most.
std::vector<std::size_t> suspects(const std::vector<double>& standardised_residuals) {
  std::vector<std::size_t> order(standardised_residuals.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(standardised_residuals[a]) > std::abs(standardised_residuals[b]);
  });
  order.resize(std::min(order.size(), kSuspects));
  return order;
}

/// A fit and the distances it rests on.
struct Trial {
  DistanceFit fit;
  std::vector<bool> used;
};

/// The best fit without one more distance, if that distance is a gross error by what the others say.
std::optional<Trial> without_gross_error(const Trial& trial, const std::vector<AnchorDistance>& distances,
                                         const AnchorLayoutParams& params) {
  constexpr std::ptrdiff_t kLeastRedundancy = 2;
  if (trial.fit.redundancy <= kLeastRedundancy) return std::nullopt;
  std::optional<Trial> best;
  for (const std::size_t k : suspects(standardised(trial.fit, distances, trial.used))) {
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
  // Few distances know the noise badly: Student's t with so many degrees of freedom.
  constexpr double kStudent = 4;
  const double doubt = 1 + kStudent / static_cast<double>(best->fit.redundancy);
  const double noise = std::max(1.0, best->fit.noise_factor() * doubt);
  if (deletion <= params.outlier_sigmas * noise) return std::nullopt;
  return best;
}

/// Whether one dimension less explains the distances nearly as well.
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

std::variant<AnchorLayout, LayoutFailure> lay_out_anchors(std::size_t anchors,
                                                          const std::vector<AnchorDistance>& distances,
                                                          const AnchorFrame& frame,
                                                          const AnchorLayoutParams& params) {
  for (const auto& distance : distances) RADIOSLAM_CHECK(distance.sigma_m > 0, "a distance has a sigma");
  if (anchors <= static_cast<std::size_t>(params.dimension))
    return LayoutFailure{LayoutRefusal::kTooFewAnchors, 0};
  const auto tied = tied_to_first(anchors, distances);
  if (const auto loose = std::find(tied.begin(), tied.end(), false); loose != tied.end())
    return LayoutFailure{LayoutRefusal::kDisconnected, static_cast<std::size_t>(loose - tied.begin())};

  Trial trial{{}, std::vector<bool>(distances.size(), true)};
  trial.fit = fit_distances(anchors, params.dimension, distances, trial.used);
  if (trial.fit.redundancy < 0)
    return LayoutFailure{LayoutRefusal::kLoose, anchor_with_fewest(anchors, distances)};
  if (is_flat(trial, distances, params)) return LayoutFailure{LayoutRefusal::kFlat, 0};
  if (!is_rigid(trial.fit, distances, trial.used))
    return LayoutFailure{LayoutRefusal::kLoose, anchor_with_fewest(anchors, distances)};
  while (auto next = without_gross_error(trial, distances, params)) trial = std::move(*next);
  const auto placed = in_anchor_frame(trial.fit.points, frame, kClearance);
  if (!placed) return LayoutFailure{LayoutRefusal::kFrame, 0};
  return layout_of(trial, *placed, distances);
}

}  // namespace radioslam
