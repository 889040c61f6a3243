#include "radioslam/radio/aoa/aoa_array.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kLightspeed_mps = 299792458;
constexpr double kPhaseStep_rad = 2;
constexpr double kBendStep_rad = 1;  // at the edge of a subarray; with twice that weaker peaks are missed
constexpr double kAveragedTurn_rad = 0.8;
// RMS phases below which an axis counts as unresolved: heights at the steepest wave searched (a fifth of what
// separates up from down), and the breadth of a straight path (where the mirror image has 0.9 of the power).
constexpr double kLevel_rad = 0.4, kStraight_rad = 0.3;
constexpr double kSteep = 0.7;  // vertical component of a straight path's direction

std::optional<Eigen::Vector3d> antenna_position(const ChannelTrack& track, const Trajectory<SE3>& trajectory,
                                                Stamp stamp) {
  const auto pose = trajectory.at(stamp);
  if (!pose) return std::nullopt;
  return track.is_two_way ? Eigen::Vector3d(*pose * track.lever_arm_m)
                          : Eigen::Vector3d(pose->rotation() * track.lever_arm_m);
}

double furthest_m(const Eigen::Matrix3Xd& positions) { return positions.colwise().norm().maxCoeff(); }

/// Sets the extent, the principal axes and the shape.
void find_shape(MovedArray& moved, const AoaParams& params) {
  const Eigen::Matrix3Xd& p = moved.array.positions_m;
  const Eigen::Matrix3Xd centred = p.colwise() - p.rowwise().mean();
  const Eigen::Matrix3d covariance = centred * centred.transpose() / static_cast<double>(p.cols());
  const auto axes = symmetric_eigen(covariance);
  moved.extent_m = (p.rowwise().maxCoeff() - p.rowwise().minCoeff()).norm();
  moved.along = axes.vectors.col(2);
  moved.normal = axes.vectors.col(0);
  const double wavenumber_radpm = (moved.is_difference ? 1 : 2) * moved.array.wavenumber_radpm;
  const double breadth_m = std::sqrt(std::max(axes.values[1], 0.0));
  const double height_rad =
      wavenumber_radpm * std::sqrt(covariance(2, 2)) * std::sin(params.max_elevation_rad);
  const bool is_straight = wavenumber_radpm * breadth_m < kStraight_rad;
  if (is_straight && std::abs(moved.along.z()) < kSteep)
    moved.shape = ArrayShape::kLine;
  else
    moved.shape = height_rad < kLevel_rad ? ArrayShape::kPlane : ArrayShape::kSpace;
}

/// Half of the largest difference of heights within a subarray.
double height_reach_m(const MovedArray& moved, double subarray_m) {
  double reach_m = 0;
  for (const SyntheticArray& part : subarrays(moved.array, subarray_m)) {
    const auto heights = part.positions_m.row(2);
    reach_m = std::max(reach_m, (heights.maxCoeff() - heights.minCoeff()) / 2);
  }
  return reach_m;
}

/// Elevations between which kappa (level_m (1 - cos e) + height_m sin e) grows by one phase step; below the
/// horizon too where the shape is kSpace.
std::vector<double> elevations_for(const MovedArray& moved, double level_m, double height_m,
                                   double max_elevation_rad) {
  std::vector<double> elevations{0};
  const double reach_m = std::hypot(level_m, height_m), lag_rad = std::atan2(level_m, height_m);
  const double step_m = kPhaseStep_rad / moved.array.wavenumber_radpm;
  if (moved.shape == ArrayShape::kLine) return elevations;
  for (double further_m = step_m; further_m - level_m < reach_m; further_m += step_m) {
    const double elevation_rad = lag_rad + std::asin((further_m - level_m) / reach_m);
    if (elevation_rad >= max_elevation_rad) break;
    elevations.push_back(elevation_rad);
    if (moved.shape == ArrayShape::kSpace) elevations.push_back(-elevation_rad);
  }
  return elevations;
}

/// Curvatures of the grid for subarrays of `subarray_m`, each of them coherent.
std::vector<double> curvatures_for(const MovedArray& moved, double subarray_m, double min_source_distance_m) {
  std::vector<double> curvatures{0};
  const double radius_m = furthest_m(moved.array.positions_m);
  const double step =
      kPhaseStep_rad / (moved.array.wavenumber_radpm * radius_m * std::min(radius_m, subarray_m));
  if (moved.is_difference) return curvatures;
  for (double rho = step; rho < 1 / min_source_distance_m + step / 2; rho += step) curvatures.push_back(rho);
  return curvatures;
}

}  // namespace

MovedArray moved_array(const ChannelTrack& track, const Trajectory<SE3>& trajectory, Stamp begin, Stamp end,
                       const AoaParams& params) {
  MovedArray moved;
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t k = 0; k < track.stamps.size(); ++k) {
    if (track.stamps[k] < begin || end < track.stamps[k]) continue;
    const auto here = antenna_position(track, trajectory, track.stamps[k]);
    if (!here) continue;
    const double step_m = positions.empty() ? 0 : (*here - positions.back()).norm();
    // An antenna pair is a baseline even where it does not move.
    if (track.is_two_way && !positions.empty() && step_m < params.min_step_m) continue;
    moved.way_m += step_m;
    positions.push_back(*here);
    moved.rows.push_back(k);
  }
  moved.is_difference = !track.is_two_way;
  SyntheticArray& array = moved.array;
  const auto n = std::ssize(positions);
  array.subcarrier_hz = track.subcarrier_hz;
  array.wavenumber_radpm = 2 * std::numbers::pi * track.carrier_hz / kLightspeed_mps;
  array.positions_m.resize(3, n);
  array.channel.resize(n, track.channel.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    array.positions_m.col(k) = positions[static_cast<std::size_t>(k)];
    array.channel.row(k) =
        track.channel.row(static_cast<Eigen::Index>(moved.rows[static_cast<std::size_t>(k)]));
  }
  if (n == 0) return moved;
  if (track.is_two_way) {
    array.centre_m = array.positions_m.rowwise().mean();
    array.positions_m.colwise() -= array.centre_m;
  }
  find_shape(moved, params);
  return moved;
}

std::vector<SyntheticArray> subarrays(const SyntheticArray& array, double subarray_m) {
  std::vector<double> path_m{0};
  for (Eigen::Index k = 1; k < array.positions_m.cols(); ++k)
    path_m.push_back(path_m.back() + (array.positions_m.col(k) - array.positions_m.col(k - 1)).norm());
  const double whole_m = path_m.back();
  const auto count = std::max<long>(1, std::lround(2 * whole_m / subarray_m) - 1);
  const double length_m = 2 * whole_m / static_cast<double>(count + 1);
  std::vector<SyntheticArray> parts;
  for (long k = 0; k < count; ++k) {
    const double from_m = static_cast<double>(k) * length_m / 2, to_m = from_m + length_m;
    const auto first = std::lower_bound(path_m.begin(), path_m.end(), from_m * (1 - 1e-12)) - path_m.begin();
    const auto last = std::upper_bound(path_m.begin(), path_m.end(), to_m * (1 + 1e-12)) - path_m.begin();
    if (last <= first) continue;
    SyntheticArray& part = parts.emplace_back();
    part.centre_m = array.centre_m;
    part.subcarrier_hz = array.subcarrier_hz;
    part.wavenumber_radpm = array.wavenumber_radpm;
    part.positions_m = array.positions_m.middleCols(first, last - first);
    part.channel = array.channel.middleRows(first, last - first);
  }
  return parts;
}

WaveGrid grid_for(const MovedArray& moved, const AoaParams& params, int azimuths) {
  const double level_m = std::min(furthest_m(moved.array.positions_m), params.subarray_m / 2);
  const double height_m = std::min(level_m, height_reach_m(moved, params.subarray_m));
  return {azimuths, elevations_for(moved, level_m, height_m, params.max_elevation_rad),
          curvatures_for(moved, params.subarray_m, params.min_source_distance_m)};
}

WaveGrid full_aperture_grid(const MovedArray& moved, const AoaParams& params, int azimuths) {
  const double whole_m = 2 * moved.way_m;
  const double height_m = moved.shape == ArrayShape::kSpace ? height_reach_m(moved, whole_m) : 0;
  return {azimuths, elevations_for(moved, 0, height_m, params.max_elevation_rad),
          curvatures_for(moved, whole_m, params.min_source_distance_m)};
}

SyntheticArray averaged(const SyntheticArray& array) {
  const double reach_m = kAveragedTurn_rad / array.wavenumber_radpm;
  SyntheticArray means = array;
  Eigen::Index count = 0;
  for (Eigen::Index first = 0; first < array.snapshots(); ++count) {
    Eigen::Index last = first;
    while (last + 1 < array.snapshots() &&
           (array.positions_m.col(last + 1) - array.positions_m.col(first)).norm() < reach_m)
      ++last;
    const Eigen::Index n = last - first + 1;
    means.positions_m.col(count) = array.positions_m.middleCols(first, n).rowwise().mean();
    means.channel.row(count) = array.channel.middleRows(first, n).colwise().mean();
    first = last + 1;
  }
  means.positions_m.conservativeResize(3, count);
  means.channel.conservativeResize(count, array.channel.cols());
  return means;
}

}  // namespace radioslam
