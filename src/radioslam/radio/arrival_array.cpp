#include "radioslam/radio/arrival_array.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kLightspeed_mps = 299792458;
constexpr double kPhaseStep_rad = 2;
constexpr double kOutOfPlane = 0.25;  // of the level extent

std::optional<Eigen::Vector3d> place(const ChannelTrack& track, const Trajectory<SE3>& trajectory,
                                     Stamp stamp) {
  const auto pose = trajectory.at(stamp);
  if (!pose) return std::nullopt;
  return track.is_two_way ? Eigen::Vector3d(*pose * track.lever_arm_m)
                          : Eigen::Vector3d(pose->rotation() * track.lever_arm_m);
}

double furthest_m(const Eigen::Matrix3Xd& positions) { return positions.colwise().norm().maxCoeff(); }

}  // namespace

MovedArray moved_array(const ChannelTrack& track, const Trajectory<SE3>& trajectory, Stamp begin, Stamp end,
                       const ArrivalParams& params) {
  MovedArray moved;
  std::vector<Eigen::Vector3d> places;
  for (std::size_t k = 0; k < track.stamps.size(); ++k) {
    if (track.stamps[k] < begin || end < track.stamps[k]) continue;
    const auto here = place(track, trajectory, track.stamps[k]);
    if (!here) continue;
    const double step_m = places.empty() ? 0 : (*here - places.back()).norm();
    // Antennas that do not move still are a baseline.
    if (track.is_two_way && !places.empty() && step_m < params.least_step_m) continue;
    moved.way_m += step_m;
    places.push_back(*here);
    moved.rows.push_back(k);
  }
  moved.is_difference = !track.is_two_way;
  SyntheticArray& array = moved.array;
  const auto n = std::ssize(places);
  array.subcarrier_hz = track.subcarrier_hz;
  array.wavenumber_radpm = 2 * std::numbers::pi * track.carrier_hz / kLightspeed_mps;
  array.positions_m.resize(3, n);
  array.channel.resize(n, track.channel.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    array.positions_m.col(k) = places[static_cast<std::size_t>(k)];
    array.channel.row(k) =
        track.channel.row(static_cast<Eigen::Index>(moved.rows[static_cast<std::size_t>(k)]));
  }
  if (n == 0) return moved;
  if (track.is_two_way) {
    array.centre_m = array.positions_m.rowwise().mean();
    array.positions_m.colwise() -= array.centre_m;
  }
  const Eigen::Vector3d spread = array.positions_m.rowwise().norm();
  moved.is_plane = spread.z() < kOutOfPlane * std::hypot(spread.x(), spread.y());
  if (moved.is_plane) array.positions_m.row(2).setZero();
  return moved;
}

std::vector<SyntheticArray> subarrays(const SyntheticArray& array, double piece_m) {
  std::vector<double> way_m{0};
  for (Eigen::Index k = 1; k < array.positions_m.cols(); ++k)
    way_m.push_back(way_m.back() + (array.positions_m.col(k) - array.positions_m.col(k - 1)).norm());
  const double whole_m = way_m.back();
  const auto count = std::max<long>(1, std::lround(2 * whole_m / piece_m) - 1);
  const double length_m = 2 * whole_m / static_cast<double>(count + 1);
  std::vector<SyntheticArray> pieces;
  for (long piece = 0; piece < count; ++piece) {
    const double from_m = static_cast<double>(piece) * length_m / 2, to_m = from_m + length_m;
    const auto first = std::lower_bound(way_m.begin(), way_m.end(), from_m * (1 - 1e-12)) - way_m.begin();
    const auto last = std::upper_bound(way_m.begin(), way_m.end(), to_m * (1 + 1e-12)) - way_m.begin();
    if (last <= first) continue;
    SyntheticArray& part = pieces.emplace_back();
    part.centre_m = array.centre_m;
    part.subcarrier_hz = array.subcarrier_hz;
    part.wavenumber_radpm = array.wavenumber_radpm;
    part.positions_m = array.positions_m.middleCols(first, last - first);
    part.channel = array.channel.middleRows(first, last - first);
  }
  return pieces;
}

WaveGrid grid_for(const MovedArray& moved, const ArrivalParams& params, int azimuths) {
  const SyntheticArray& array = moved.array;
  const double radius_m = furthest_m(array.positions_m);
  const double reach_m = std::min(radius_m, params.subarray_m / 2);
  WaveGrid grid;
  grid.azimuths = azimuths;
  const double most_curvature = moved.is_difference ? 0 : 1 / params.nearest_source_m;
  const double step = kPhaseStep_rad / (array.wavenumber_radpm * radius_m * radius_m);
  for (double rho = step; rho < most_curvature + step / 2; rho += step) grid.curvatures_per_m.push_back(rho);
  if (moved.is_plane) {
    const double level_step = kPhaseStep_rad / (array.wavenumber_radpm * reach_m);
    for (double level = 1 - level_step; level > std::cos(params.most_elevation_rad); level -= level_step)
      grid.elevations_rad.push_back(std::acos(level));
  } else {
    const double rise_step = kPhaseStep_rad / (array.wavenumber_radpm * reach_m);
    for (double rise = rise_step; rise < params.most_elevation_rad; rise += rise_step) {
      grid.elevations_rad.push_back(rise);
      grid.elevations_rad.push_back(-rise);
    }
  }
  return grid;
}

SyntheticArray thinned(const SyntheticArray& array, Eigen::Index every) {
  SyntheticArray some = array;
  const Eigen::Index n = (array.snapshots() + every - 1) / every;
  some.positions_m.resize(3, n);
  some.channel.resize(n, array.channel.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    some.positions_m.col(k) = array.positions_m.col(k * every);
    some.channel.row(k) = array.channel.row(k * every);
  }
  return some;
}

}  // namespace radioslam
