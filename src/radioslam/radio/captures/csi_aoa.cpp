#include "radioslam/radio/captures/csi_aoa.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "radioslam/radio/aoa/synthetic_array.hpp"

namespace radioslam {
namespace {

constexpr double kElevationSigmas = 2;  // largest sigma of an elevation, in sigmas of the azimuth

/// Direction of a source in the body frame, seen from the body's origin instead of the array's centre.
Eigen::Vector3d seen_from_body(const AoaEstimate& estimate, const AoaDirection& direction,
                               double curvature_per_m) {
  Eigen::Vector3d u = WaveSource{direction.azimuth_rad, direction.elevation_rad, 0}.direction();
  if (curvature_per_m > 0 && !estimate.centre_m.isZero(0))
    u += curvature_per_m * (estimate.centre_m - estimate.T_frame_body.translation());
  return (estimate.T_frame_body.rotation().conjugate() * u).normalized();
}

double azimuth_of(const Eigen::Vector3d& u) { return std::atan2(u.y(), u.x()); }

/// Whether the mirror solution differs in azimuth, not only in the elevation's sign.
bool is_aside(const AoaPeak& peak) {
  const double apart_rad = std::remainder(peak.mirror->azimuth_rad - peak.azimuth_rad, 2 * std::numbers::pi);
  return std::abs(apart_rad) > 2 * peak.sigma_rad;
}

bool resolves_elevation(const AoaEstimate& estimate, const AoaPeak& peak) {
  return estimate.resolves_height && (!peak.mirror || is_aside(peak)) &&
         peak.elevation_sigma_rad <= kElevationSigmas * peak.sigma_rad;
}

AoaPath path_of(const AoaEstimate& estimate, const AoaDirection& direction, const AoaPeak& peak,
                int dimension) {
  const Eigen::Vector3d u = seen_from_body(estimate, direction, peak.curvature_per_m);
  AoaPath path{azimuth_of(u), std::nullopt, peak.sigma_rad, peak.power_db};
  if (dimension == 3 && resolves_elevation(estimate, peak)) {
    path.elevation_rad = std::asin(std::clamp(u.z(), -1.0, 1.0));
    path.sigma_rad = std::max(peak.sigma_rad, peak.elevation_sigma_rad);
  }
  return path;
}

/// The profile rotated into the body frame, on the same grid.
std::vector<float> turned_to_body(const AoaEstimate& estimate) {
  const Eigen::Vector3d forward = estimate.T_frame_body.rotation() * Eigen::Vector3d::UnitX();
  const auto n = std::ssize(estimate.profile);
  const auto shift = std::lround(azimuth_of(forward) / (2 * std::numbers::pi) * static_cast<double>(n));
  std::vector<float> turned;
  for (std::ptrdiff_t k = 0; k < n; ++k)
    turned.push_back(estimate.profile[static_cast<std::size_t>(((k + shift) % n + n) % n)]);
  return turned;
}

}  // namespace

AoaMeasurement measurement_of(const Mission& mission, const CsiAttempt& attempt,
                              const AoaEstimate& estimate) {
  AoaMeasurement measured;
  measured.stamp = estimate.stamp;
  measured.receiver = RobotIndex(attempt.receiver);
  measured.transmitter.robot = RobotIndex(attempt.transmitter);
  measured.transmitter.lever_arm_m = mission.robots[attempt.transmitter].csi->antennas_m.front();
  for (const AoaPeak& peak : estimate.peaks) {
    // The strongest peak is occasionally misclassified, and losing it costs more than a false path.
    if (peak.is_cross_term && &peak != &estimate.peaks.front()) continue;
    const AoaDirection direction{peak.azimuth_rad, peak.elevation_rad};
    measured.paths.push_back(path_of(estimate, direction, peak, mission.dimension));
    if (peak.mirror && is_aside(peak))
      measured.paths.push_back(path_of(estimate, *peak.mirror, peak, mission.dimension));
  }
  return measured;
}

MeasuredAoaResult profile_of(const Mission& mission, const CsiAttempt& attempt, const AoaEstimate& estimate) {
  MeasuredAoaResult result;
  result.receiver = mission.robots[attempt.receiver].id;
  result.transmitter = mission.robots[attempt.transmitter].id;
  result.stamp = estimate.stamp;
  for (const AoaPeak& peak : estimate.peaks)
    result.peaks.push_back(
        {azimuth_of(seen_from_body(estimate, {peak.azimuth_rad, peak.elevation_rad}, peak.curvature_per_m)),
         peak.sigma_rad, peak.power_db, peak.is_cross_term});
  result.profile = turned_to_body(estimate);
  return result;
}

void add_estimated_azimuths(std::vector<MeasuredAoaResult>& profiles,
                            const std::vector<RobotResult>& robots) {
  const auto pose_of = [&](const std::string& id, Stamp stamp) -> std::optional<SE3> {
    for (const RobotResult& robot : robots)
      if (robot.id == id && robot.placed) return robot.estimate.at(stamp);
    return std::nullopt;
  };
  for (MeasuredAoaResult& profile : profiles) {
    const auto receiver = pose_of(profile.receiver, profile.stamp);
    const auto transmitter = pose_of(profile.transmitter, profile.stamp);
    if (receiver && transmitter)
      profile.estimated_azimuth_rad = azimuth_of(receiver->inverse() * transmitter->translation());
  }
}

}  // namespace radioslam
