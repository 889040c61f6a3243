#include "radioslam/sim/sensors/lidar_scanner.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/sim/motion/stamps.hpp"

namespace radioslam {
namespace {

/// Elevations of published scanners: Velodyne's VLP-16 and HDL-64E.
struct BeamFan {
  double lowest_deg = 0;
  double highest_deg = 0;
};
constexpr BeamFan kLevel{0, 0}, kVlp16{-15, 15}, kHdl64{-24.8, 2};
constexpr int kMaxVlpBeams = 32;

BeamFan fan_of(const LidarScannerParams& params) {
  if (params.lidar_lowest_deg < params.lidar_highest_deg)
    return {params.lidar_lowest_deg, params.lidar_highest_deg};
  if (params.lidar_beams <= 1) return kLevel;
  return params.lidar_beams <= kMaxVlpBeams ? kVlp16 : kHdl64;
}

/// A beam's direction, independent of azimuth: horizontal and vertical part of a unit vector.
struct Beam {
  double level = 1;
  double up = 0;
};

std::vector<Beam> beams_of(const LidarScannerParams& params) {
  std::vector<Beam> beams;
  for (const double elevation : beam_elevations_rad(params))
    beams.push_back({std::cos(elevation), std::sin(elevation)});
  return beams;
}

double azimuth_rad(const LidarScannerParams& params, int step) {
  const double ratio = (step + 0.5) / params.lidar_azimuth_steps;
  return params.lidar_view_deg * kRadiansPerDegree * (ratio - 0.5);
}

/// Measured range to a surface at the true range, with noise; nothing if it is not detected.
std::optional<double> measure_m(double true_m, const LidarScannerParams& params, Rng& rng) {
  const double measured_m = true_m + rng.normal(0, params.lidar_sigma_m);
  const bool lost = rng.uniform() < params.lidar_dropout_ratio;
  if (lost || measured_m < params.lidar_min_range_m || measured_m > params.range_m) return std::nullopt;
  return measured_m;
}

}  // namespace

std::vector<double> beam_elevations_rad(const LidarScannerParams& params) {
  const BeamFan fan = fan_of(params);
  std::vector<double> elevations;
  for (int beam = 0; beam < params.lidar_beams; ++beam) {
    const double ratio = params.lidar_beams == 1 ? 0.5 : beam / (params.lidar_beams - 1.0);
    elevations.push_back(kRadiansPerDegree * (fan.lowest_deg + ratio * (fan.highest_deg - fan.lowest_deg)));
  }
  return elevations;
}

LidarScan sweep(const RayWorld& world, const TrueMotion& motion, const LidarScannerParams& params,
                Stamp stamp, Rng rng) {
  const std::vector<Beam> beams = beams_of(params);
  const Eigen::Vector3d scanner(0, 0, params.lidar_height_m);
  LidarScan scan;
  for (int step = 0; step < params.lidar_azimuth_steps; ++step) {
    const double azimuth = azimuth_rad(params, step);
    const auto time_s =
        static_cast<float>((azimuth / (2 * std::numbers::pi) + 0.5) / params.lidar_rotation_hz);
    const SE3 T_common_body =
        motion.pose_at({stamp.ns + Stamp::from_seconds(static_cast<double>(time_s)).ns});
    const Eigen::Vector3d origin = T_common_body * scanner;
    for (const Beam& beam : beams) {
      const Eigen::Vector3d direction(beam.level * std::cos(azimuth), beam.level * std::sin(azimuth),
                                      beam.up);
      const auto hit = world.cast({origin, T_common_body.rotate(direction)}, params.range_m);
      if (!hit) continue;
      const auto range_m = measure_m(hit->range_m, params, rng);
      if (!range_m) continue;
      scan.points.push_back((scanner + *range_m * direction).cast<float>());
      scan.times_s.push_back(time_s);
    }
  }
  return scan;
}

LidarLog scan_along(std::shared_ptr<const RayWorld> world, std::shared_ptr<const TrueMotion> motion,
                    const LidarScannerParams& params, const Rng& rng) {
  if (params.lidar_beams == 0) return {};
  const double last_s = motion->end().seconds() - 1 / params.lidar_rotation_hz;
  LidarLog log;
  log.stamps = regular_stamps(0, last_s, params.lidar_rotation_hz);
  log.read = [stamps = log.stamps, world = std::move(world), motion = std::move(motion), params,
              rng](std::size_t k) { return sweep(*world, *motion, params, stamps[k], rng.split(k)); };
  return log;
}

}  // namespace radioslam
