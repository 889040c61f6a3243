#include "radioslam/sim/worlds/hills.hpp"

#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr int kWaves = 6;
constexpr double kMinHill_m = 150;
constexpr double kMaxHill_m = 500;
constexpr double kOnGround_m = 1e-6;  ///< height below which a ray has reached the ground
constexpr int kMaxSteps = 200;        ///< of a ray; a dozen are typical

}  // namespace

Hills::Hills(double sigma_height_m, Rng rng) {
  for (int k = 0; k < kWaves; ++k) {
    const double direction = rng.uniform(0, 2 * std::numbers::pi);
    const double wavenumber = 2 * std::numbers::pi / rng.uniform(kMinHill_m, kMaxHill_m);
    waves_.push_back({sigma_height_m * std::sqrt(2.0 / kWaves),
                      wavenumber * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                      rng.uniform(0, 2 * std::numbers::pi)});
  }
}

double Hills::height_m(const Eigen::Vector2d& position) const {
  double height = 0;
  for (const Wave& wave : waves_)
    height += wave.amplitude_m * std::sin(wave.wavenumber_per_m.dot(position) + wave.phase_rad);
  return height;
}

Eigen::Vector2d Hills::gradient(const Eigen::Vector2d& position) const {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (const Wave& wave : waves_)
    slope += wave.amplitude_m * std::cos(wave.wavenumber_per_m.dot(position) + wave.phase_rad) *
             wave.wavenumber_per_m;
  return slope;
}

SE3 Hills::pose_on_ground(const SE2& T_floor_body) const {
  const Eigen::Vector2d& place = T_floor_body.translation();
  const Eigen::Vector2d slope = gradient(place);
  const Eigen::Vector2d heading = T_floor_body.rotate(Eigen::Vector2d::UnitX());
  const Eigen::Vector3d x = Eigen::Vector3d(heading.x(), heading.y(), slope.dot(heading)).normalized();
  const Eigen::Vector3d z = Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
  Eigen::Matrix3d rotation;
  rotation << x, z.cross(x), z;
  return {{place.x(), place.y(), height_m(place)}, Eigen::Quaterniond(rotation)};
}

double Hills::max_curvature_per_m(const Eigen::Vector2d& direction) const {
  double curvature = 0;
  for (const Wave& wave : waves_)
    curvature += std::abs(wave.amplitude_m) * std::pow(wave.wavenumber_per_m.dot(direction), 2);
  return curvature;
}

std::optional<double> Hills::ray_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                   double max_m) const {
  const Eigen::Vector2d along = direction.head<2>();
  const double curvature = max_curvature_per_m(along);
  double along_m = 0, over_m = origin.z() - height_m(origin.head<2>());
  if (over_m <= kOnGround_m) return std::nullopt;
  for (int step = 0; step < kMaxSteps && over_m > kOnGround_m; ++step) {
    const Eigen::Vector2d place = (origin + along_m * direction).head<2>();
    const double rise = direction.z() - gradient(place).dot(along);
    const double closing = std::sqrt(rise * rise + 2 * curvature * over_m) - rise;
    if (2 * over_m > closing * (max_m - along_m)) return std::nullopt;  // still above the ground at max_m
    along_m += 2 * over_m / closing;
    over_m = origin.z() + along_m * direction.z() - height_m((origin + along_m * direction).head<2>());
  }
  return along_m;
}

}  // namespace radioslam
