#include "radioslam/radio/beam_objective.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

constexpr Eigen::Index kBlocks = 5;  // of every piece of the way
constexpr int kClimbs = 20, kStepHalvings = 6;
constexpr double kFlattest = 1e-6;  // bend of a direction against that of the steepest
const double kWidest_rad = std::numbers::pi / std::sqrt(3.0);

/// The longest step of a climb in azimuth, elevation and curvature.
const Eigen::Vector3d kLongestSteps(0.02, 0.05, 0.1);

WaveSource moved(WaveSource source, const Eigen::Vector3d& step) {
  source.azimuth_rad = wrap_angle(source.azimuth_rad + step.x());
  source.elevation_rad += step.y();
  source.curvature_per_m += step.z();
  return source;
}

WaveSource within(WaveSource source, const SourceBounds& bounds) {
  source.elevation_rad =
      std::clamp(source.elevation_rad, bounds.least_elevation_rad, bounds.most_elevation_rad);
  source.curvature_per_m = std::clamp(source.curvature_per_m, 0.0, bounds.most_curvature_per_m);
  return source;
}

/// Of azimuth, elevation and curvature those that may move along a slope, or at all.
std::vector<Eigen::Index> free_at(const WaveSource& source, const SourceBounds& bounds,
                                  const Eigen::Vector3d& slope = Eigen::Vector3d::Zero()) {
  const auto is_free = [](double value, double least, double most, double up) {
    return least < most && (value > least || up > 0) && (value < most || up < 0);
  };
  std::vector<Eigen::Index> free{0};
  if (is_free(source.elevation_rad, bounds.least_elevation_rad, bounds.most_elevation_rad, slope.y()))
    free.push_back(1);
  if (is_free(source.curvature_per_m, 0, bounds.most_curvature_per_m, slope.z())) free.push_back(2);
  return free;
}

}  // namespace

/// J' and J'' over (azimuth, elevation, curvature), and the blocks' shares of J'.
struct BeamObjective::Slope {
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();  ///< -J''
  std::vector<Eigen::Vector3d> shares;
};

namespace {

/// Of kappa e over azimuth, elevation and curvature, at one place.
struct PhaseSlope {
  Eigen::Vector3d first;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< of the angles; curvature's part is left out
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

  double phase_rad(const Eigen::Vector3d& p) const { return wavenumber_radpm_ * excess_way_m(u_, rho_, p); }

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

BeamObjective::BeamObjective(const std::vector<SyntheticArray>& pieces, const DelayTable& delays,
                             const WaveSource& near) {
  const Eigen::Vector3d u = near.direction();
  for (const SyntheticArray& array : pieces) {
    const double energy =
        static_cast<double>(array.channel.size()) * std::max(array.channel.squaredNorm(), 1e-300);
    Eigen::RowVectorXcd beam = Eigen::RowVectorXcd::Zero(array.channel.cols());
    for (Eigen::Index k = 0; k < array.snapshots(); ++k)
      beam += array.channel.row(k) *
              std::polar(1.0, array.wavenumber_radpm *
                                  excess_way_m(u, near.curvature_per_m, array.positions_m.col(k)));
    Eigen::Index best = 0;
    (beam * delays.turns()).cwiseAbs().maxCoeff(&best);
    pieces_.push_back({array.positions_m, array.channel * delays.turns().col(best) / std::sqrt(energy),
                       array.wavenumber_radpm});
  }
}

double BeamObjective::value(const WaveSource& source) const {
  const Eigen::Vector3d u = source.direction();
  double value = 0;
  for (const Piece& piece : pieces_) {
    std::complex<double> sum = 0;
    for (Eigen::Index k = 0; k < piece.weights.size(); ++k)
      sum +=
          piece.weights[k] * std::polar(1.0, piece.wavenumber_radpm * excess_way_m(u, source.curvature_per_m,
                                                                                   piece.positions_m.col(k)));
    value += std::norm(sum);
  }
  return value / static_cast<double>(pieces_.size());
}

std::vector<double> BeamObjective::shares(const WaveSource& source) const {
  const Eigen::Vector3d u = source.direction();
  std::vector<double> shares;
  for (const Piece& piece : pieces_) {
    std::array<std::complex<double>, kBlocks> parts{};
    const Eigen::Index n = piece.weights.size();
    for (Eigen::Index k = 0; k < n; ++k)
      parts[static_cast<std::size_t>(k * kBlocks / n)] +=
          piece.weights[k] * std::polar(1.0, piece.wavenumber_radpm * excess_way_m(u, source.curvature_per_m,
                                                                                   piece.positions_m.col(k)));
    const std::complex<double> sum = std::accumulate(parts.begin(), parts.end(), std::complex<double>(0));
    for (const auto& part : parts)
      shares.push_back((std::conj(sum) * part).real() / static_cast<double>(pieces_.size()));
  }
  return shares;
}

BeamObjective::Slope BeamObjective::slope(const WaveSource& source) const {
  Slope result;
  for (const Piece& piece : pieces_) {
    const Eigen::Index n = piece.weights.size();
    std::complex<double> sum = 0;
    std::vector<Eigen::Vector3cd> parts(static_cast<std::size_t>(kBlocks), Eigen::Vector3cd::Zero());
    std::array<std::complex<double>, kBlocks> sums{};
    Eigen::Matrix3cd second = Eigen::Matrix3cd::Zero();
    const PhaseSlopes slopes(source, piece.wavenumber_radpm);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Vector3d p = piece.positions_m.col(k);
      const PhaseSlope turn = slopes.at(p);
      const std::complex<double> z = piece.weights[k] * std::polar(1.0, slopes.phase_rad(p));
      const std::complex<double> jz(-z.imag(), z.real());
      sum += z;
      parts[static_cast<std::size_t>(k * kBlocks / n)] += jz * turn.first;
      sums[static_cast<std::size_t>(k * kBlocks / n)] += z;
      second += jz * turn.second - z * (turn.first * turn.first.transpose());
    }
    Eigen::Vector3cd first = Eigen::Vector3cd::Zero();
    for (const auto& part : parts) first += part;
    // The phase that turns all of a piece alike moves no peak: in the blocks' shares it would count as noise.
    const Eigen::Vector3d common = (std::conj(sum) * first).imag() / std::max(std::norm(sum), 1e-300);
    for (std::size_t b = 0; b < parts.size(); ++b)
      result.shares.push_back(2 * (std::conj(sum) * parts[b]).real() +
                              2 * (std::conj(sum) * sums[b]).imag() * common);
    result.gradient += 2 * (std::conj(sum) * first).real();
    result.bend -= 2 * ((first.conjugate() * first.transpose()).real() + (std::conj(sum) * second).real());
  }
  return result;
}

namespace {

/// Uphill where the value bends either way: Newton's step with the bend's size (saddle-free; Dauphin et al.
/// 2014), in units of the longest steps.
Eigen::Vector3d uphill(const Eigen::Vector3d& gradient, const Eigen::Matrix3d& bend,
                       const std::vector<Eigen::Index>& free) {
  const Eigen::VectorXd reach = kLongestSteps(free), slope = gradient(free).cwiseProduct(reach);
  const Eigen::MatrixXd scaled = reach.asDiagonal() * bend(free, free) * reach.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(scaled);
  const Eigen::VectorXd size = axes.eigenvalues().cwiseAbs();
  const double least = std::max(kFlattest * size.maxCoeff(), 1e-300);
  const Eigen::VectorXd along = (axes.eigenvectors().transpose() * slope).cwiseQuotient(size.cwiseMax(least));
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  step(free) = (axes.eigenvectors() * along).cwiseProduct(reach);
  return step.cwiseMax(-kLongestSteps).cwiseMin(kLongestSteps);
}

}  // namespace

WaveSource BeamObjective::climb(WaveSource from, const SourceBounds& bounds) const {
  double here = value(from);
  for (int round = 0; round < kClimbs; ++round) {
    const Slope s = slope(from);
    Eigen::Vector3d step = uphill(s.gradient, s.bend, free_at(from, bounds, s.gradient));
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
  for (const auto& share : s.shares) scatter += share * share.transpose();
  if (pieces_.size() > 1) scatter *= 2;
  std::vector<Eigen::Index> free = free_at(peak, bounds);
  if (Eigen::MatrixXd(s.bend(free, free)).llt().info() != Eigen::Success) free = {0};
  if (s.bend(0, 0) <= 0) return {kWidest_rad, kWidest_rad};
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(s.bend(free, free)).inverse();
  const Eigen::MatrixXd covariance = inverse * scatter(free, free) * inverse;
  const bool has_elevation = free.size() > 1 && free[1] == 1;
  return {std::min(kWidest_rad, std::sqrt(covariance(0, 0))),
          has_elevation ? std::min(kWidest_rad, std::sqrt(covariance(1, 1))) : kWidest_rad};
}

}  // namespace radioslam
