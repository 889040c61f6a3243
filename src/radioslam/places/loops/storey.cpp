#include "radioslam/places/loops/storey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/lidar/structure_fit.hpp"

namespace radioslam {
namespace {

constexpr double kMinStorey_m = 2.5;  // height
constexpr float kIndoors_m = 30;      // range of most points on a storey
constexpr float kOverhead_m = 0.5;    // height above the body
constexpr double kMaxTilt = 0.02;     // slope of the ceiling in the body frame
constexpr double kMinLayer_m = 0.15;  // half the thickness of what is in one plane
constexpr int kPlaneSteps = 5;
constexpr double kCeilingShare = 0.3, kWallShare = 0.5;
constexpr std::size_t kMinOverhead = 20;

float quantile(std::vector<float>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// z = plane . (x, y, 1), by least squares.
Eigen::Vector3d plane_through(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3d normal = 1e-6 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d at(point.x(), point.y(), 1);
    normal += at * at.transpose();
    right += at * point.z();
  }
  return ldlt_solve(normal, right);
}

/// Whether much of what is overhead lies in one plane that is level but for the body's tilt, at the top.
bool has_ceiling(const ScanPyramid& scan, double range_m) {
  std::vector<Eigen::Vector3d> not_walls;
  std::vector<float> heights_m;
  for (const Surfel& surfel : scan.all) {
    if (surfel.position.z() <= kOverhead_m) continue;
    heights_m.push_back(surfel.position.z());
    if (horizontal_share(surfel) < kWallShare) not_walls.push_back(surfel.position.cast<double>());
  }
  if (heights_m.size() < kMinOverhead) return false;
  const double least = kCeilingShare * static_cast<double>(heights_m.size());
  Eigen::Vector3d plane(0, 0, static_cast<double>(quantile(heights_m, 0.95)));
  double layer_m = kMinLayer_m + 2 * kMaxTilt * range_m;
  std::vector<Eigen::Vector3d> within;
  for (int k = 0; k < kPlaneSteps; ++k) {
    within.clear();
    for (const Eigen::Vector3d& point : not_walls)
      if (std::abs(point.z() - plane.dot(Eigen::Vector3d(point.x(), point.y(), 1))) <= layer_m)
        within.push_back(point);
    if (static_cast<double>(within.size()) < least) return false;
    plane = plane_through(within);
    layer_m = std::max(layer_m / 2, kMinLayer_m);
  }
  return plane.head<2>().norm() <= 2 * kMaxTilt;
}

}  // namespace

std::optional<double> storey_height_m(const ScanPyramid& scan) {
  std::vector<float> heights_m, ranges_m;
  for (const Surfel& surfel : scan.all) {
    heights_m.push_back(surfel.position.z());
    ranges_m.push_back(surfel.position.head<2>().norm());
  }
  if (heights_m.empty()) return std::nullopt;
  const float range_m = quantile(ranges_m, 0.9);
  if (range_m > kIndoors_m && !has_ceiling(scan, static_cast<double>(range_m))) return std::nullopt;
  return std::max(kMinStorey_m, static_cast<double>(quantile(heights_m, 0.98) - quantile(heights_m, 0.05)));
}

double prior_density(double squared_distance) {
  constexpr std::array<double, 4> kScales{0.25, 0.5, 1, 2};
  double sum = 0;
  for (const double a : kScales) sum += std::exp(-squared_distance / (2 * a * a)) / a;
  return sum / static_cast<double>(kScales.size());
}

double other_storeys(double storey_m, double z_m, const std::vector<ExpectedHeight>& expected,
                     double sigma_m) {
  constexpr double kLeast = 1e-12;
  const auto density = [&](double at_m) {
    double sum = kLeast;
    for (const auto& [expected_m, share] : expected) {
      const double off = (at_m - expected_m) / sigma_m;
      sum += share * prior_density(off * off);
    }
    return sum;
  };
  double sum = 0;
  for (const double side : {-1.0, 1.0}) {
    double most = 0;
    for (const ExpectedHeight& at : expected)
      most = std::max(most, density(z_m + side * std::clamp(side * (at.z_m - z_m), storey_m, 2 * storey_m)));
    sum += most;
  }
  return sum / density(z_m);
}

}  // namespace radioslam
