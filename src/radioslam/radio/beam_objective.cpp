#include "radioslam/radio/beam_objective.hpp"

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
constexpr int kClimbs = 12, kHalvings = 6;
constexpr double kAngleStep_rad = 1e-4, kCurvatureStep_per_m = 1e-4;
constexpr double kLongestClimb_rad = 0.02;
constexpr double kCurvatureReach_per_m = 0.1;

WaveSource moved(WaveSource source, double azimuth_rad, double curvature_per_m) {
  source.azimuth_rad = wrap_angle(source.azimuth_rad + azimuth_rad);
  source.curvature_per_m += curvature_per_m;
  return source;
}

}  // namespace

/// J' and J'' over (azimuth, curvature), and the blocks' shares of J'.
struct BeamObjective::Slope {
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d bend = Eigen::Matrix2d::Zero();  ///< -J''
  std::vector<Eigen::Vector2d> shares;
};

BeamObjective::BeamObjective(const std::vector<SyntheticArray>& pieces, const DelayTable& delays,
                             const WaveSource& near) {
  for (const SyntheticArray& array : pieces) {
    const double energy =
        static_cast<double>(array.channel.size()) * std::max(array.channel.squaredNorm(), 1e-300);
    Eigen::RowVectorXcd beam = Eigen::RowVectorXcd::Zero(array.channel.cols());
    for (Eigen::Index k = 0; k < array.snapshots(); ++k)
      beam += array.channel.row(k) *
              std::polar(1.0, array.wavenumber_radpm * excess_way_m(near, array.positions_m.col(k)));
    Eigen::Index best = 0;
    (beam * delays.turns()).cwiseAbs().maxCoeff(&best);
    pieces_.push_back({array.positions_m, array.channel * delays.turns().col(best) / std::sqrt(energy),
                       array.wavenumber_radpm});
  }
}

double BeamObjective::value(const WaveSource& source) const {
  double value = 0;
  for (const Piece& piece : pieces_) {
    std::complex<double> sum = 0;
    for (Eigen::Index k = 0; k < piece.weights.size(); ++k)
      sum += piece.weights[k] *
             std::polar(1.0, piece.wavenumber_radpm * excess_way_m(source, piece.positions_m.col(k)));
    value += std::norm(sum);
  }
  return value / static_cast<double>(pieces_.size());
}

std::vector<double> BeamObjective::shares(const WaveSource& source) const {
  std::vector<double> shares;
  for (const Piece& piece : pieces_) {
    std::array<std::complex<double>, kBlocks> parts{};
    const Eigen::Index n = piece.weights.size();
    for (Eigen::Index k = 0; k < n; ++k)
      parts[static_cast<std::size_t>(k * kBlocks / n)] +=
          piece.weights[k] *
          std::polar(1.0, piece.wavenumber_radpm * excess_way_m(source, piece.positions_m.col(k)));
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
    std::vector<Eigen::Vector2cd> parts(static_cast<std::size_t>(kBlocks), Eigen::Vector2cd::Zero());
    std::array<std::complex<double>, kBlocks> sums{};
    Eigen::Matrix2cd second = Eigen::Matrix2cd::Zero();
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Vector3d p = piece.positions_m.col(k);
      const auto excess = [&](double a, double c) { return excess_way_m(moved(source, a, c), p); };
      const double here = excess(0, 0), left = excess(-kAngleStep_rad, 0), right = excess(kAngleStep_rad, 0);
      const double bent = excess(0, kCurvatureStep_per_m);
      const Eigen::Vector2d turn =
          piece.wavenumber_radpm *
          Eigen::Vector2d((right - left) / (2 * kAngleStep_rad), (bent - here) / kCurvatureStep_per_m);
      const double turn_bend =
          piece.wavenumber_radpm * (right - 2 * here + left) / (kAngleStep_rad * kAngleStep_rad);
      const std::complex<double> z = piece.weights[k] * std::polar(1.0, piece.wavenumber_radpm * here);
      const std::complex<double> jz(-z.imag(), z.real());
      sum += z;
      parts[static_cast<std::size_t>(k * kBlocks / n)] += jz * turn;
      sums[static_cast<std::size_t>(k * kBlocks / n)] += z;
      second -= z * (turn * turn.transpose());
      second(0, 0) += jz * turn_bend;
    }
    Eigen::Vector2cd first = Eigen::Vector2cd::Zero();
    for (const auto& part : parts) first += part;
    // The phase that turns all of a piece alike moves no peak: in the blocks' shares it would count as noise.
    const Eigen::Vector2d common = (std::conj(sum) * first).imag() / std::max(std::norm(sum), 1e-300);
    for (std::size_t b = 0; b < parts.size(); ++b)
      result.shares.push_back(2 * (std::conj(sum) * parts[b]).real() +
                              2 * (std::conj(sum) * sums[b]).imag() * common);
    result.gradient += 2 * (std::conj(sum) * first).real();
    result.bend -= 2 * ((first.conjugate() * first.transpose()).real() + (std::conj(sum) * second).real());
  }
  return result;
}

WaveSource BeamObjective::climb(WaveSource from, double most_curvature_per_m) const {
  double here = value(from);
  for (int round = 0; round < kClimbs; ++round) {
    const Slope s = slope(from);
    Eigen::Vector2d step = Eigen::Vector2d::Zero();
    if (most_curvature_per_m > 0 && s.bend.determinant() > 0 && s.bend(0, 0) > 0)
      step = s.bend.inverse() * s.gradient;
    else if (s.bend(0, 0) > 0)
      step.x() = s.gradient.x() / s.bend(0, 0);
    else
      step.x() = std::copysign(kLongestClimb_rad, s.gradient.x());
    step.x() = std::clamp(step.x(), -kLongestClimb_rad, kLongestClimb_rad);
    step.y() = std::clamp(step.y(), -kCurvatureReach_per_m, kCurvatureReach_per_m);
    bool climbed = false;
    for (int half = 0; half < kHalvings && !climbed; ++half, step /= 2) {
      WaveSource next = moved(from, step.x(), step.y());
      next.curvature_per_m = std::clamp(next.curvature_per_m, 0.0, most_curvature_per_m);
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

double BeamObjective::sigma_rad(const WaveSource& peak, double most_curvature_per_m) const {
  const Slope s = slope(peak);
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const auto& share : s.shares) scatter += share * share.transpose();
  if (pieces_.size() > 1) scatter *= 2;
  const bool is_inside = peak.curvature_per_m > 0 && peak.curvature_per_m < most_curvature_per_m;
  const double widest_rad = std::numbers::pi / std::sqrt(3.0);
  if (is_inside && s.bend(0, 0) > 0 && s.bend.determinant() > 0) {
    const Eigen::Matrix2d inverse = s.bend.inverse();
    return std::min(widest_rad, std::sqrt((inverse * scatter * inverse)(0, 0)));
  }
  if (s.bend(0, 0) <= 0) return widest_rad;
  return std::min(widest_rad, std::sqrt(scatter(0, 0)) / s.bend(0, 0));
}

}  // namespace radioslam
