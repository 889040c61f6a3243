#include "radioslam/radio/aoa/beam_objective.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

constexpr Eigen::Index kBlocks = 5;  // per subarray
constexpr int kMaxIterations = 20, kStepHalvings = 6;
constexpr double kMinEigenvalueRatio = 1e-6;  // smallest eigenvalue of the Hessian, relative to the largest
const double kWidest_rad = std::numbers::pi / std::sqrt(3.0);

/// Largest step per iteration in azimuth, elevation and curvature.
const Eigen::Vector3d kMaxClimbStep(0.02, 0.05, 0.1);

WaveSource moved(WaveSource source, const Eigen::Vector3d& step) {
  source.azimuth_rad = wrap_angle(source.azimuth_rad + step.x());
  source.elevation_rad += step.y();
  source.curvature_per_m += step.z();
  return source;
}

WaveSource within(WaveSource source, const SourceBounds& bounds) {
  source.elevation_rad = std::clamp(source.elevation_rad, bounds.min_elevation_rad, bounds.max_elevation_rad);
  source.curvature_per_m = std::clamp(source.curvature_per_m, 0.0, bounds.max_curvature_per_m);
  return source;
}

/// Indices of azimuth, elevation and curvature that are free to move along `slope`, or at all if it is zero.
std::vector<Eigen::Index> free_at(const WaveSource& source, const SourceBounds& bounds,
                                  const Eigen::Vector3d& slope = Eigen::Vector3d::Zero()) {
  const auto is_free = [](double value, double least, double most, double up) {
    return least < most && (value > least || up > 0) && (value < most || up < 0);
  };
  std::vector<Eigen::Index> free{0};
  if (is_free(source.elevation_rad, bounds.min_elevation_rad, bounds.max_elevation_rad, slope.y()))
    free.push_back(1);
  if (is_free(source.curvature_per_m, 0, bounds.max_curvature_per_m, slope.z())) free.push_back(2);
  return free;
}

}  // namespace

/// J' and J'' over (azimuth, elevation, curvature), and the blocks' contributions to J'.
struct BeamObjective::Slope {
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d negative_hessian = Eigen::Matrix3d::Zero();  ///< -J''
  std::vector<Eigen::Vector3d> block_gradients;
};

namespace {

/// Derivatives of kappa e over azimuth, elevation and curvature, at one position.
struct PhaseSlope {
  Eigen::Vector3d first;
  Eigen::Matrix3d second =
      Eigen::Matrix3d::Zero();  ///< angles only; curvature's second derivatives are neglected
};

/// With d = p.u, q = |p|^2 and N = |rho p - u|: e = (rho q - 2 d) / (N + 1), de/dd = -1 / N,
/// d2e/dd2 = -rho / N^3, dN/drho = (rho q - d) / N.
class PhaseSlopes {
 public:
  PhaseSlopes(const WaveSource& source, double wavenumber_radpm)
      : u_(source.direction()), rho_(source.curvature_per_m), wavenumber_radpm_(wavenumber_radpm) {
    const double ca = std::cos(source.azimuth_rad), sa = std::sin(source.azimuth_rad);
    const double ce = std::cos(source.elevation_rad), se = std::sin(source.elevation_rad);
    by_azimuth_ = {-ce * sa, ce * ca, 0};
    by_elevation_ = {-se * ca, -se * sa, ce};
    by_azimuth_twice_ = {-ce * ca, -ce * sa, 0};
    by_both_ = {se * sa, -se * ca, 0};
  }

  double phase_rad(const Eigen::Vector3d& p) const { return wavenumber_radpm_ * excess_path_m(u_, rho_, p); }

  PhaseSlope at(const Eigen::Vector3d& p) const {
    const double d = p.dot(u_), q = p.squaredNorm(), n = (rho_ * p - u_).norm();
    const double a = p.dot(by_azimuth_), e = p.dot(by_elevation_), bent = rho_ / (n * n * n);
    const double more = q / (n + 1) - (rho_ * q - 2 * d) * (rho_ * q - d) / (n * (n + 1) * (n + 1));
    PhaseSlope slope{wavenumber_radpm_ * Eigen::Vector3d(-a / n, -e / n, more)};
    slope.second(0, 0) = -p.dot(by_azimuth_twice_) / n - bent * a * a;
    slope.second(1, 1) = d / n - bent * e * e;
    slope.second(0, 1) = slope.second(1, 0) = -p.dot(by_both_) / n - bent * a * e;
    slope.second *= wavenumber_radpm_;
    return slope;
  }

 private:
  Eigen::Vector3d u_, by_azimuth_, by_elevation_, by_azimuth_twice_, by_both_;
  double rho_, wavenumber_radpm_;
};

}  // namespace

BeamObjective::BeamObjective(const std::vector<SyntheticArray>& subarrays, const DelayTable& delays,
                             const WaveSource& near) {
  const Eigen::Vector3d u = near.direction();
  for (const SyntheticArray& array : subarrays) {
    const double energy =
        static_cast<double>(array.channel.size()) * std::max(array.channel.squaredNorm(), 1e-300);
    Eigen::RowVectorXcd beam = Eigen::RowVectorXcd::Zero(array.channel.cols());
    for (Eigen::Index k = 0; k < array.snapshots(); ++k)
      beam += array.channel.row(k) *
              std::polar(1.0, array.wavenumber_radpm *
                                  excess_path_m(u, near.curvature_per_m, array.positions_m.col(k)));
    Eigen::Index best = 0;
    (beam * delays.turns()).cwiseAbs().maxCoeff(&best);
    subarrays_.push_back({array.positions_m, array.channel * delays.turns().col(best) / std::sqrt(energy),
                          array.wavenumber_radpm});
  }
}

double BeamObjective::value(const WaveSource& source) const {
  const Eigen::Vector3d u = source.direction();
  double value = 0;
  for (const Subarray& subarray : subarrays_) {
    std::complex<double> sum = 0;
    for (Eigen::Index k = 0; k < subarray.weights.size(); ++k)
      sum += subarray.weights[k] *
             std::polar(1.0, subarray.wavenumber_radpm *
                                 excess_path_m(u, source.curvature_per_m, subarray.positions_m.col(k)));
    value += std::norm(sum);
  }
  return value / static_cast<double>(subarrays_.size());
}

std::vector<double> BeamObjective::shares(const WaveSource& source) const {
  const Eigen::Vector3d u = source.direction();
  std::vector<double> contributions;
  for (const Subarray& subarray : subarrays_) {
    std::array<std::complex<double>, kBlocks> parts{};
    const Eigen::Index n = subarray.weights.size();
    for (Eigen::Index k = 0; k < n; ++k)
      parts[static_cast<std::size_t>(k * kBlocks / n)] +=
          subarray.weights[k] *
          std::polar(1.0, subarray.wavenumber_radpm *
                              excess_path_m(u, source.curvature_per_m, subarray.positions_m.col(k)));
    const std::complex<double> sum = std::accumulate(parts.begin(), parts.end(), std::complex<double>(0));
    for (const auto& part : parts)
      contributions.push_back((std::conj(sum) * part).real() / static_cast<double>(subarrays_.size()));
  }
  return contributions;
}

BeamObjective::Slope BeamObjective::slope(const WaveSource& source) const {
  Slope result;
  for (const Subarray& subarray : subarrays_) {
    const Eigen::Index n = subarray.weights.size();
    std::complex<double> sum = 0;
    std::vector<Eigen::Vector3cd> parts(static_cast<std::size_t>(kBlocks), Eigen::Vector3cd::Zero());
    std::array<std::complex<double>, kBlocks> sums{};
    Eigen::Matrix3cd second = Eigen::Matrix3cd::Zero();
    const PhaseSlopes slopes(source, subarray.wavenumber_radpm);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Vector3d p = subarray.positions_m.col(k);
      const PhaseSlope turn = slopes.at(p);
      const std::complex<double> z = subarray.weights[k] * std::polar(1.0, slopes.phase_rad(p));
      const std::complex<double> jz(-z.imag(), z.real());
      sum += z;
      parts[static_cast<std::size_t>(k * kBlocks / n)] += jz * turn.first;
      sums[static_cast<std::size_t>(k * kBlocks / n)] += z;
      second += jz * turn.second - z * (turn.first * turn.first.transpose());
    }
    Eigen::Vector3cd first = Eigen::Vector3cd::Zero();
    for (const auto& part : parts) first += part;
    // A phase common to the subarray moves no peak; in the blocks' gradients it would count as noise.
    const Eigen::Vector3d common = (std::conj(sum) * first).imag() / std::max(std::norm(sum), 1e-300);
    for (std::size_t b = 0; b < parts.size(); ++b)
      result.block_gradients.push_back(2 * (std::conj(sum) * parts[b]).real() +
                                       2 * (std::conj(sum) * sums[b]).imag() * common);
    result.gradient += 2 * (std::conj(sum) * first).real();
    result.negative_hessian -=
        2 * ((first.conjugate() * first.transpose()).real() + (std::conj(sum) * second).real());
  }
  return result;
}

namespace {

/// Ascent step whether or not the objective is concave: saddle-free Newton step, with the absolute values of
/// the Hessian's eigenvalues (Dauphin et al. 2014), in units of the largest steps.
Eigen::Vector3d uphill(const Eigen::Vector3d& gradient, const Eigen::Matrix3d& negative_hessian,
                       const std::vector<Eigen::Index>& free) {
  const Eigen::VectorXd reach = kMaxClimbStep(free), slope = gradient(free).cwiseProduct(reach);
  const Eigen::MatrixXd scaled = reach.asDiagonal() * negative_hessian(free, free) * reach.asDiagonal();
  const auto axes = symmetric_eigen(scaled);
  const Eigen::VectorXd size = axes.values.cwiseAbs();
  const double least = std::max(kMinEigenvalueRatio * size.maxCoeff(), 1e-300);
  const Eigen::VectorXd along = (axes.vectors.transpose() * slope).cwiseQuotient(size.cwiseMax(least));
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  step(free) = (axes.vectors * along).cwiseProduct(reach);
  return step.cwiseMax(-kMaxClimbStep).cwiseMin(kMaxClimbStep);
}

}  // namespace

WaveSource BeamObjective::climb(WaveSource from, const SourceBounds& bounds) const {
  double here = value(from);
  for (int round = 0; round < kMaxIterations; ++round) {
    const Slope s = slope(from);
    Eigen::Vector3d step = uphill(s.gradient, s.negative_hessian, free_at(from, bounds, s.gradient));
    bool climbed = false;
    for (int half = 0; half < kStepHalvings && !climbed; ++half, step /= 2) {
      const WaveSource next = within(moved(from, step), bounds);
      const double there = value(next);
      if (there <= here) continue;
      climbed = true;
      from = next;
      here = there;
    }
    if (!climbed) break;
  }
  return from;
}

SourceSigma BeamObjective::sigma(const WaveSource& peak, const SourceBounds& bounds) const {
  const Slope s = slope(peak);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& gradient : s.block_gradients) scatter += gradient * gradient.transpose();
  if (subarrays_.size() > 1) scatter *= 2;
  std::vector<Eigen::Index> free = free_at(peak, bounds);
  if (!Cholesky<Eigen::MatrixXd>(s.negative_hessian(free, free)).succeeded()) free = {0};
  if (s.negative_hessian(0, 0) <= 0) return {kWidest_rad, kWidest_rad};
  const Eigen::MatrixXd by_hessian = inverse<Eigen::MatrixXd>(s.negative_hessian(free, free));
  const Eigen::MatrixXd covariance = by_hessian * scatter(free, free) * by_hessian;
  const bool has_elevation = free.size() > 1 && free[1] == 1;
  return {std::min(kWidest_rad, std::sqrt(covariance(0, 0))),
          has_elevation ? std::min(kWidest_rad, std::sqrt(covariance(1, 1))) : kWidest_rad};
}

}  // namespace radioslam
