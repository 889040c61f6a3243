#include "radioslam/radio/arrival_peaks.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/radio/arrival_slopes.hpp"
#include "radioslam/radio/beam_objective.hpp"
#include "radioslam/radio/beam_sums.hpp"

namespace radioslam {
namespace {

constexpr int kRefinements = 3;          // rounds of all waves
constexpr double kOverlap = 2;           // pieces that each packet stands in
constexpr double kReach = 3;             // resolutions of a piece within which peaks may be one wave
constexpr double kTwin = 0.95;           // of a peak's power: its mirror is as likely
constexpr double kGhost = 4;             // times the power of the waves there is a product's
constexpr double kOnePath = 4;           // resolutions within which waves are parts of one path
constexpr double kMostGhostWave = 0.05;  // of the strongest wave
constexpr double kMostGhostShare = 0.5;  // of the channel

double decibels(double ratio) { return 10 * std::log10(std::max(ratio, 1e-12)); }

/// Where the array tells sources apart.
SourceBounds bounds_for(const MovedArray& moved, const ArrivalParams& params) {
  const double most_rad = moved.shape == ArrayShape::kLine ? 0 : params.most_elevation_rad;
  return {moved.is_difference ? 0 : 1 / params.nearest_source_m,
          moved.shape == ArrayShape::kSpace ? -most_rad : 0, most_rad};
}

/// Of the way whose profiles are added; a pair of antennas is one piece.
double piece_length_m(const MovedArray& moved, const ArrivalParams& params) {
  return moved.is_difference ? 1e9 : params.subarray_m;
}

/// Over azimuth, the best of elevation and curvature.
AzimuthProfile over_azimuth(const WaveGrid& grid, const std::vector<double>& power) {
  const auto around = static_cast<std::size_t>(grid.azimuths);
  AzimuthProfile profile;
  profile.power.assign(around, -1);
  profile.source.resize(around);
  for (std::size_t k = 0; k < power.size(); ++k) {
    if (power[k] <= profile.power[k % around]) continue;
    profile.power[k % around] = power[k];
    profile.source[k % around] = grid.source(k);
  }
  return profile;
}

/// The same source on the other side of the upright plane along the way, and of the way's own plane: where
/// the way lies in one of them its phases are the same.
std::array<WaveSource, 2> twins_of(const WaveSource& source, const MovedArray& moved) {
  WaveSource across = source, beyond = source;
  across.azimuth_rad = wrap_angle(2 * std::atan2(moved.along.y(), moved.along.x()) - source.azimuth_rad);
  const Eigen::Vector3d u = source.direction();
  const Eigen::Vector3d v = u - 2 * u.dot(moved.normal) * moved.normal;
  beyond.azimuth_rad = std::atan2(v.y(), v.x());
  beyond.elevation_rad = std::asin(std::clamp(v.z(), -1.0, 1.0));
  return {across, beyond};
}

/// The first of them that explains as much and is another direction.
std::optional<ArrivalDirection> mirror_of(const WaveSource& source, const ArrivalPeak& peak,
                                          const BeamObjective& objective, const MovedArray& moved) {
  for (const WaveSource& twin : twins_of(source, moved)) {
    const bool is_apart = std::abs(wrap_angle(source.azimuth_rad - twin.azimuth_rad)) > 2 * peak.sigma_rad ||
                          std::abs(source.elevation_rad - twin.elevation_rad) > 2 * peak.elevation_sigma_rad;
    if (is_apart && objective.value(twin) > kTwin * objective.value(source))
      return ArrivalDirection{twin.azimuth_rad, twin.elevation_rad};
  }
  return std::nullopt;
}

/// Elevation's sigma on a level way, which measures its cosine, no better than the floor. Near the level the
/// slope of that is none: half of what twice the cosine's sigma reaches.
double level_elevation_sigma_rad(double elevation_rad, double sigma_rad, double floor_rad) {
  const double cosine = std::cos(elevation_rad);
  const double sigma = std::hypot(sigma_rad * std::sin(elevation_rad), floor_rad);
  const double highest = std::acos(std::max(cosine - 2 * sigma, -1.0));
  const double lowest = std::acos(std::min(cosine + 2 * sigma, 1.0));
  return std::max(highest - elevation_rad, elevation_rad - lowest) / 2;
}

/// A peak at a source, but for its power.
ArrivalPeak peak_at(const WaveSource& source, const BeamObjective& objective, const MovedArray& moved,
                    const ArrivalParams& params) {
  SourceSigma sigma = objective.sigma(source, bounds_for(moved, params));
  if (moved.shape == ArrayShape::kPlane)
    sigma.elevation_rad =
        level_elevation_sigma_rad(source.elevation_rad, sigma.elevation_rad, params.sigma_floor_rad);
  ArrivalPeak peak;
  peak.azimuth_rad = source.azimuth_rad;
  peak.elevation_rad = source.elevation_rad;
  peak.curvature_per_m = source.curvature_per_m;
  peak.sigma_rad = std::hypot(sigma.azimuth_rad, params.sigma_floor_rad);
  peak.elevation_sigma_rad = std::hypot(sigma.elevation_rad, params.sigma_floor_rad);
  peak.explained = std::min(objective.value(source), 1.0);
  peak.mirror = mirror_of(source, peak, objective, moved);
  return peak;
}

std::vector<std::size_t> local_maxima(const std::vector<double>& power) {
  const std::size_t n = power.size();
  std::vector<std::size_t> peaks;
  for (std::size_t k = 0; k < n; ++k)
    if (power[k] >= power[(k + n - 1) % n] && power[k] > power[(k + 1) % n]) peaks.push_back(k);
  std::stable_sort(peaks.begin(), peaks.end(),
                   [&](std::size_t a, std::size_t b) { return power[a] > power[b]; });
  return peaks;
}

/// The chance that of two peaks' values the lesser is the greater in truth: their difference's blocks say how
/// sure its sign is.
double chance_of_other(const std::vector<double>& shares, const std::vector<double>& other) {
  double difference = 0, scatter = 0;
  for (std::size_t b = 0; b < shares.size(); ++b) difference += shares[b] - other[b];
  const double mean = difference / static_cast<double>(shares.size());
  for (std::size_t b = 0; b < shares.size(); ++b) scatter += std::pow(shares[b] - other[b] - mean, 2);
  const double sigma = std::sqrt(kOverlap * scatter);
  return sigma > 0 ? 0.5 * std::erfc(difference / (sigma * std::numbers::sqrt2)) : 0;
}

/// Peaks that the array hardly parts: the direct wave may be any of them, as likely as their values' order is
/// unsure.
void widen_by_neighbours(std::vector<ArrivalPeak>& peaks, const std::vector<std::vector<double>>& shares,
                         double reach_rad) {
  std::vector<double> variance;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    double sum = peaks[i].sigma_rad * peaks[i].sigma_rad;
    for (std::size_t j = 0; j < peaks.size(); ++j) {
      const double apart = wrap_angle(peaks[j].azimuth_rad - peaks[i].azimuth_rad);
      if (i != j && std::abs(apart) < reach_rad) sum += chance_of_other(shares[i], shares[j]) * apart * apart;
    }
    variance.push_back(sum);
  }
  for (std::size_t i = 0; i < peaks.size(); ++i) peaks[i].sigma_rad = std::sqrt(variance[i]);
}

/// How far apart in direction two waves of one way are told apart.
double resolution_rad(const MovedArray& one_way) {
  const auto& p = one_way.array.positions_m;
  const double extent_m = (p.rowwise().maxCoeff() - p.rowwise().minCoeff()).norm();
  return 2 * std::numbers::pi / (one_way.array.wavenumber_radpm * std::max(extent_m, 1e-6));
}

}  // namespace

AzimuthProfile bartlett_profile(const MovedArray& moved, const ArrivalParams& params) {
  const WaveGrid grid = grid_for(moved, params, params.azimuths);
  const DelayTable delays = delay_table(moved.array.subcarrier_hz);
  const SyntheticArray array = moved.is_difference ? moved.array : averaged(moved.array);
  const auto pieces = subarrays(array, piece_length_m(moved, params));
  std::vector<double> power(grid.size(), 0);
  for (const SyntheticArray& piece : pieces) {
    const ArrayBeams beams = array_beams(piece, grid, delays);
    for (std::size_t k = 0; k < power.size(); ++k)
      power[k] += static_cast<double>(beams.power[k]) / static_cast<double>(pieces.size());
  }
  return over_azimuth(grid, power);
}

AzimuthProfile music_profile(const MovedArray& moved, const ArrivalParams& params) {
  const Eigen::MatrixXcd& h = moved.array.channel;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> eigen(h.adjoint() * h);
  const Eigen::Index values = std::min(h.rows(), h.cols());
  const auto power_of = [&](Eigen::Index k) {
    return std::max(eigen.eigenvalues()[h.cols() - 1 - k], 1e-12 * eigen.eigenvalues()[h.cols() - 1]);
  };
  // Minimum description length over the eigenvalues, K snapshots of them.
  const auto samples = static_cast<double>(h.rows());
  Eigen::Index signals = 1;
  double shortest = std::numeric_limits<double>::infinity();
  for (Eigen::Index order = 1; order < std::min<Eigen::Index>(values, BeamInput::kMostSignals + 1); ++order) {
    double logs = 0, mean = 0;
    for (Eigen::Index k = order; k < values; ++k) {
      logs += std::log(power_of(k));
      mean += power_of(k);
    }
    const auto rest = static_cast<double>(values - order), free = static_cast<double>(order);
    const double length = samples * (rest * std::log(mean / rest) - logs) +
                          0.5 * free * (2 * static_cast<double>(values) - free) * std::log(samples);
    if (length >= shortest) continue;
    shortest = length;
    signals = order;
  }
  Eigen::MatrixXcd basis = h * eigen.eigenvectors().rightCols(signals);
  basis.colwise().normalize();
  const WaveGrid grid = grid_for(moved, params, params.azimuths);
  const BeamInput input = beam_input(moved.array.positions_m, moved.array.wavenumber_radpm, basis);
  const BeamKernel kernel = beam_kernel();
  std::vector<double> power;
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const WaveSource source = grid.source(k);
    const Eigen::Vector3f u = source.direction().cast<float>();
    const BeamDirection to{u.x(), u.y(), u.z(), static_cast<float>(source.curvature_per_m)};
    BeamSum sum;
    kernel(input, &to, 1, &sum);
    double fit = 0;
    for (std::size_t r = 0; r < input.signals; ++r) fit += static_cast<double>(std::norm(sum.z[r]));
    power.push_back(1 / std::max(1 - fit / static_cast<double>(h.rows()), 1e-6));
  }
  return over_azimuth(grid, power);
}

std::vector<ArrivalPeak> find_peaks(const AzimuthProfile& profile, const MovedArray& moved,
                                    const ArrivalParams& params) {
  const auto pieces = subarrays(moved.array, piece_length_m(moved, params));
  const DelayTable delays = delay_table(moved.array.subcarrier_hz);
  const auto maxima = local_maxima(profile.power);
  std::vector<ArrivalPeak> peaks;
  std::vector<std::vector<double>> shares;
  for (const std::size_t k : maxima) {
    if (std::ssize(peaks) == params.peaks) break;
    const BeamObjective objective(pieces, delays, profile.source[k]);
    const WaveSource source = objective.climb(profile.source[k], bounds_for(moved, params));
    const bool is_known = std::any_of(peaks.begin(), peaks.end(), [&](const ArrivalPeak& other) {
      return std::abs(wrap_angle(source.azimuth_rad - other.azimuth_rad)) <
             std::numbers::pi / params.azimuths;
    });
    if (is_known) continue;
    peaks.push_back(peak_at(source, objective, moved, params));
    peaks.back().power_db = decibels(profile.power[k] / profile.power[maxima.front()]);
    shares.push_back(objective.shares(source));
  }
  if (!moved.is_difference)
    widen_by_neighbours(peaks, shares,
                        kReach * 2 * std::numbers::pi / (moved.array.wavenumber_radpm * params.subarray_m));
  return peaks;
}

std::vector<ArrivalPeak> peaks_of_waves(const std::vector<WavePath>& waves, const MovedArray& one_way,
                                        const ArrivalParams& params) {
  const double apart_rad = resolution_rad(one_way) / 2;
  const DelayTable delays = delay_table(one_way.array.subcarrier_hz);
  const auto is_stronger = [](const WavePath& a, const WavePath& b) {
    return std::norm(a.amplitude) > std::norm(b.amplitude);
  };
  std::vector<WavePath> sorted = waves, distinct;
  std::stable_sort(sorted.begin(), sorted.end(), is_stronger);
  for (const WavePath& wave : sorted)
    if (std::ssize(distinct) < params.peaks &&
        std::none_of(distinct.begin(), distinct.end(), [&](const WavePath& other) {
          return std::abs(wrap_angle(wave.source.azimuth_rad - other.source.azimuth_rad)) < apart_rad;
        }))
      distinct.push_back(wave);
  distinct =
      refine_paths(distinct, averaged(one_way.array), delays, bounds_for(one_way, params), kRefinements);
  std::stable_sort(distinct.begin(), distinct.end(), is_stronger);
  std::vector<ArrivalPeak> peaks;
  for (const WavePath& wave : distinct) {
    std::vector<WavePath> others;
    for (const WavePath& other : distinct)
      if (&other != &wave) others.push_back(other);
    SyntheticArray alone = one_way.array;
    alone.channel -= channel_of(others, one_way.array);
    const BeamObjective objective({alone}, delays, wave.source);
    peaks.push_back(peak_at(wave.source, objective, one_way, params));
    peaks.back().power_db = decibels(std::norm(wave.amplitude) / std::norm(distinct.front().amplitude));
    peaks.back().explained =
        std::min(BeamObjective({one_way.array}, delays, wave.source).value(wave.source), 1.0);
  }
  return peaks;
}

void name_ghosts(std::vector<ArrivalPeak>& peaks, const std::vector<WavePath>& waves,
                 const MovedArray& one_way) {
  const double near = std::max(resolution_rad(one_way) / 2, 2 * std::numbers::pi / kWaveAzimuths);
  // A product's level direction is short, and on a way that sees no height its peak stands as high as that
  // says; a straight way sees one component alone.
  const auto apart = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const Eigen::Vector3d way = a - b;
    if (one_way.shape == ArrayShape::kLine) return std::abs(way.dot(one_way.along));
    return one_way.shape == ArrayShape::kPlane ? way.head<2>().norm() : way.norm();
  };
  double strongest = 0;
  for (const WavePath& wave : waves) strongest = std::max(strongest, std::norm(wave.amplitude));
  for (ArrivalPeak& peak : peaks) {
    const Eigen::Vector3d at = WaveSource{peak.azimuth_rad, peak.elevation_rad, 0}.direction();
    double here = 0, product = 0;
    for (const WavePath& a : waves) {
      if (apart(a.source.direction(), at) < near) here = std::max(here, std::norm(a.amplitude));
      for (const WavePath& b : waves)
        if (&a < &b && apart(a.source.direction(), b.source.direction()) > 2 * kOnePath * near &&
            apart((a.source.direction() + b.source.direction()) / 2, at) < near)
          product = std::max(product, 2 * std::abs(a.amplitude) * std::abs(b.amplitude));
    }
    peak.is_ghost =
        product > kGhost * here && here < kMostGhostWave * strongest && peak.explained < kMostGhostShare;
  }
}

}  // namespace radioslam
