#include "radioslam/radio/aoa/aoa_peaks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "radioslam/base/units.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/radio/aoa/beam_objective.hpp"
#include "radioslam/radio/aoa/delay_alignment.hpp"
#include "radioslam/radio/aoa/steering_sums.hpp"

namespace radioslam {
namespace {

constexpr int kRefinements = 3;             // rounds over all waves
constexpr double kOverlap = 2;              // subarrays that each packet belongs to
constexpr double kUnresolved = 3;           // in resolutions of a subarray: closer peaks may be one wave
constexpr double kMirrorRatio = 0.95;       // of a peak's power: a mirror image above it is as likely
constexpr double kCrossTerm = 4;            // factor over the power of waves there that marks a product
constexpr double kOnePathResolutions = 4;   // in resolutions: closer waves belong to one path
constexpr double kMaxCrossTermWave = 0.05;  // power relative to the strongest wave
constexpr double kMaxCrossTermRatio = 0.5;  // fraction of the channel explained

double bounded_decibels(double ratio) { return decibels(std::max(ratio, 1e-12)); }

/// Where the array resolves sources.
SourceBounds bounds_for(const MovedArray& moved, const AoaParams& params) {
  const double max_rad = moved.shape == ArrayShape::kLine ? 0 : params.max_elevation_rad;
  return {moved.is_difference ? 0 : 1 / params.min_source_distance_m,
          moved.shape == ArrayShape::kSpace ? -max_rad : 0, max_rad};
}

/// Length of the subarrays; an antenna pair is not divided.
double subarray_length_m(const MovedArray& moved, const AoaParams& params) {
  return moved.is_difference ? 1e9 : params.subarray_m;
}

/// Maximum over elevation and curvature at each azimuth.
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

/// The source mirrored at the vertical plane along the path, and at the path's own plane: where the path is
/// in that plane, its phases are the same.
std::array<WaveSource, 2> mirror_images(const WaveSource& source, const MovedArray& moved) {
  WaveSource across = source, beyond = source;
  across.azimuth_rad = wrap_angle(2 * std::atan2(moved.along.y(), moved.along.x()) - source.azimuth_rad);
  const Eigen::Vector3d u = source.direction();
  const Eigen::Vector3d v = u - 2 * u.dot(moved.normal) * moved.normal;
  beyond.azimuth_rad = std::atan2(v.y(), v.x());
  beyond.elevation_rad = std::asin(std::clamp(v.z(), -1.0, 1.0));
  return {across, beyond};
}

/// The first mirror image that explains as much and is a different direction.
std::optional<AoaDirection> mirror_of(const WaveSource& source, const AoaPeak& peak,
                                      const BeamObjective& objective, const MovedArray& moved) {
  for (const WaveSource& image : mirror_images(source, moved)) {
    const bool is_apart = std::abs(wrap_angle(source.azimuth_rad - image.azimuth_rad)) > 2 * peak.sigma_rad ||
                          std::abs(source.elevation_rad - image.elevation_rad) > 2 * peak.elevation_sigma_rad;
    if (is_apart && objective.value(image) > kMirrorRatio * objective.value(source))
      return AoaDirection{image.azimuth_rad, image.elevation_rad};
  }
  return std::nullopt;
}

/// Sigma of the elevation on a level path, which observes only its cosine, with at least the floor's sigma.
/// As the cosine's slope vanishes near the level: half of the elevations' range within two sigmas of the
/// cosine.
double level_elevation_sigma_rad(double elevation_rad, double sigma_rad, double floor_rad) {
  const double cosine = std::cos(elevation_rad);
  const double sigma = std::hypot(sigma_rad * std::sin(elevation_rad), floor_rad);
  const double highest = std::acos(std::max(cosine - 2 * sigma, -1.0));
  const double lowest = std::acos(std::min(cosine + 2 * sigma, 1.0));
  return std::max(highest - elevation_rad, elevation_rad - lowest) / 2;
}

/// The peak at a source, without its power.
AoaPeak peak_at(const WaveSource& source, const BeamObjective& objective, const MovedArray& moved,
                const AoaParams& params) {
  SourceSigma sigma = objective.sigma(source, bounds_for(moved, params));
  if (moved.shape == ArrayShape::kPlane)
    sigma.elevation_rad =
        level_elevation_sigma_rad(source.elevation_rad, sigma.elevation_rad, params.sigma_floor_rad);
  AoaPeak peak;
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

/// Probability that the smaller of two peaks is in truth the larger, from the scatter of their difference
/// over the blocks.
double probability_of_swap(const std::vector<double>& blocks, const std::vector<double>& other) {
  double difference = 0, scatter = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) difference += blocks[b] - other[b];
  const double mean = difference / static_cast<double>(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) scatter += std::pow(blocks[b] - other[b] - mean, 2);
  const double sigma = std::sqrt(kOverlap * scatter);
  return sigma > 0 ? 0.5 * std::erfc(difference / (sigma * std::numbers::sqrt2)) : 0;
}

/// Widens the sigma of peaks that the array hardly resolves: the direct wave may be any of them, weighted by
/// the probability that their order is wrong.
void widen_by_unresolved(std::vector<AoaPeak>& peaks, const std::vector<std::vector<double>>& blocks,
                         double reach_rad) {
  std::vector<double> variance;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    double sum = peaks[i].sigma_rad * peaks[i].sigma_rad;
    for (std::size_t j = 0; j < peaks.size(); ++j) {
      const double apart = wrap_angle(peaks[j].azimuth_rad - peaks[i].azimuth_rad);
      if (i != j && std::abs(apart) < reach_rad)
        sum += probability_of_swap(blocks[i], blocks[j]) * apart * apart;
    }
    variance.push_back(sum);
  }
  for (std::size_t i = 0; i < peaks.size(); ++i) peaks[i].sigma_rad = std::sqrt(variance[i]);
}

/// Angular resolution of the one-way channel.
double resolution_rad(const MovedArray& one_way) {
  const auto& p = one_way.array.positions_m;
  const double extent_m = (p.rowwise().maxCoeff() - p.rowwise().minCoeff()).norm();
  return 2 * std::numbers::pi / (one_way.array.wavenumber_radpm * std::max(extent_m, 1e-6));
}

}  // namespace

AzimuthProfile bartlett_profile(const MovedArray& moved, const AoaParams& params) {
  const WaveGrid grid = grid_for(moved, params, params.azimuths);
  const DelayTable delays = delay_table(moved.array.subcarrier_hz);
  const SyntheticArray array = moved.is_difference ? moved.array : averaged(moved.array);
  const auto parts = subarrays(array, subarray_length_m(moved, params));
  std::vector<double> power(grid.size(), 0);
  for (const SyntheticArray& part : parts) {
    const ArrayBeams beams = array_beams(part, grid, delays);
    for (std::size_t k = 0; k < power.size(); ++k)
      power[k] += static_cast<double>(beams.power[k]) / static_cast<double>(parts.size());
  }
  return over_azimuth(grid, power);
}

AzimuthProfile music_profile(const MovedArray& moved, const AoaParams& params) {
  const Eigen::MatrixXcd& h = moved.array.channel;
  const auto eigen = symmetric_eigen<Eigen::MatrixXcd>(h.adjoint() * h);
  const Eigen::Index values = std::min(h.rows(), h.cols());
  const auto power_of = [&](Eigen::Index k) {
    return std::max(eigen.values[h.cols() - 1 - k], 1e-12 * eigen.values[h.cols() - 1]);
  };
  // Minimum description length over the eigenvalues, from K snapshots.
  const auto samples = static_cast<double>(h.rows());
  Eigen::Index signals = 1;
  double shortest = std::numeric_limits<double>::infinity();
  for (Eigen::Index order = 1; order < std::min<Eigen::Index>(values, BeamInput::kMaxSignals + 1); ++order) {
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
  Eigen::MatrixXcd basis = h * eigen.vectors.rightCols(signals);
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

std::vector<AoaPeak> find_peaks(const AzimuthProfile& profile, const MovedArray& moved,
                                const AoaParams& params) {
  const auto parts = subarrays(moved.array, subarray_length_m(moved, params));
  const DelayTable delays = delay_table(moved.array.subcarrier_hz);
  const auto maxima = local_maxima(profile.power);
  std::vector<AoaPeak> peaks;
  std::vector<std::vector<double>> blocks;
  for (const std::size_t k : maxima) {
    if (std::ssize(peaks) == params.peaks) break;
    const BeamObjective objective(parts, delays, profile.source[k]);
    const WaveSource source = objective.climb(profile.source[k], bounds_for(moved, params));
    const bool is_known = std::any_of(peaks.begin(), peaks.end(), [&](const AoaPeak& other) {
      return std::abs(wrap_angle(source.azimuth_rad - other.azimuth_rad)) <
             std::numbers::pi / params.azimuths;
    });
    if (is_known) continue;
    peaks.push_back(peak_at(source, objective, moved, params));
    peaks.back().power_db = bounded_decibels(profile.power[k] / profile.power[maxima.front()]);
    blocks.push_back(objective.shares(source));
  }
  if (!moved.is_difference)
    widen_by_unresolved(
        peaks, blocks,
        kUnresolved * 2 * std::numbers::pi / (moved.array.wavenumber_radpm * params.subarray_m));
  return peaks;
}

std::vector<AoaPeak> peaks_of_waves(const std::vector<WavePath>& waves, const MovedArray& one_way,
                                    const AoaParams& params) {
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
  std::vector<AoaPeak> peaks;
  for (const WavePath& wave : distinct) {
    std::vector<WavePath> others;
    for (const WavePath& other : distinct)
      if (&other != &wave) others.push_back(other);
    SyntheticArray alone = one_way.array;
    alone.channel -= channel_of(others, one_way.array);
    const BeamObjective objective({alone}, delays, wave.source);
    peaks.push_back(peak_at(wave.source, objective, one_way, params));
    peaks.back().power_db =
        bounded_decibels(std::norm(wave.amplitude) / std::norm(distinct.front().amplitude));
    peaks.back().explained =
        std::min(BeamObjective({one_way.array}, delays, wave.source).value(wave.source), 1.0);
  }
  return peaks;
}

void mark_cross_terms(std::vector<AoaPeak>& peaks, const std::vector<WavePath>& waves,
                      const MovedArray& one_way) {
  const double near = std::max(resolution_rad(one_way) / 2, 2 * std::numbers::pi / kWaveAzimuths);
  // The horizontal part of a product's direction is shortened, which a level path takes for elevation; a
  // straight path observes only the component along itself.
  const auto apart = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const Eigen::Vector3d difference = a - b;
    if (one_way.shape == ArrayShape::kLine) return std::abs(difference.dot(one_way.along));
    return one_way.shape == ArrayShape::kPlane ? difference.head<2>().norm() : difference.norm();
  };
  double strongest = 0;
  for (const WavePath& wave : waves) strongest = std::max(strongest, std::norm(wave.amplitude));
  for (AoaPeak& peak : peaks) {
    const Eigen::Vector3d at = WaveSource{peak.azimuth_rad, peak.elevation_rad, 0}.direction();
    double here = 0, product = 0;
    for (const WavePath& a : waves) {
      if (apart(a.source.direction(), at) < near) here = std::max(here, std::norm(a.amplitude));
      for (const WavePath& b : waves)
        if (&a < &b && apart(a.source.direction(), b.source.direction()) > 2 * kOnePathResolutions * near &&
            apart((a.source.direction() + b.source.direction()) / 2, at) < near)
          product = std::max(product, 2 * std::abs(a.amplitude) * std::abs(b.amplitude));
    }
    peak.is_cross_term = product > kCrossTerm * here && here < kMaxCrossTermWave * strongest &&
                         peak.explained < kMaxCrossTermRatio;
  }
}

}  // namespace radioslam
