#include "radioslam/map/scanner_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr std::size_t kScans = 4;
constexpr std::size_t kPointsPerScan = 1500;
constexpr double kBin_rad = 0.1 * std::numbers::pi / 180;
constexpr double kMaxHeight_m = 4, kMaxOffset_m = 1.5;
constexpr double kMinGain = 0.5;  // nats of entropy by which rings are told from a continuous fan

/// Returns of a few scans as recorded, in the body frame at their own times, and how many a scan has.
Points some_points(const LidarLog& log, const ScanPointParams& params, double& returns_per_scan) {
  Points points;
  const std::size_t scans = std::min(kScans, log.size());
  for (std::size_t n = 0; n < scans; ++n) {
    const std::size_t k = n * log.size() / scans;
    const auto scan = filter_and_deskew({log.read(k).points, {}, {}}, SE3::Tangent::Zero(), params).points;
    returns_per_scan += static_cast<double>(scan.size()) / static_cast<double>(scans);
    const std::size_t stride = 1 + scan.size() / kPointsPerScan;
    for (std::size_t i = 0; i < scan.size(); i += stride) points.push_back(scan[i]);
  }
  return points;
}

double reach_m(const Points& points) {
  constexpr double kQuantile = 0.99, kMargin = 1.1;
  std::vector<double> ranges;
  for (const Eigen::Vector3f& point : points) ranges.push_back(static_cast<double>(point.norm()));
  const auto at =
      ranges.begin() + static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(ranges.size() - 1));
  std::nth_element(ranges.begin(), at, ranges.end());
  return kMargin * *at;
}

/// Entropy of the elevations at which the points are seen from `origin`, in nats.
double entropy(const Points& points, const Eigen::Vector3d& origin) {
  const auto bins = static_cast<std::size_t>(std::numbers::pi / kBin_rad) + 2;
  std::vector<double> counts(bins);
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d ray = point.cast<double>() - origin;
    const double elevation = std::atan2(ray.z(), ray.head<2>().norm());
    // Shared between two bins, so that a ring on their border is not spread by rounding.
    const double at = (elevation + std::numbers::pi / 2) / kBin_rad;
    const auto bin = static_cast<std::size_t>(at);
    counts[bin] += 1 - (at - std::floor(at));
    counts[bin + 1] += at - std::floor(at);
  }
  double sum = 0;
  for (const double count : counts)
    if (count > 0) sum -= count * std::log(count / static_cast<double>(points.size()));
  return sum / static_cast<double>(points.size());
}

/// Moves one coordinate to the value within `reach_m` at which the entropy is least.
void search(const Points& points, Eigen::Vector3d& origin, int axis, double reach_m, double step_m) {
  const double middle = origin[axis];
  const auto steps = static_cast<int>(reach_m / step_m);
  double least = entropy(points, origin);
  for (int n = -steps; n <= steps; ++n) {
    Eigen::Vector3d trial = origin;
    trial[axis] = middle + n * step_m;
    if (const double value = entropy(points, trial); value < least) least = value, origin[axis] = trial[axis];
  }
}

/// Without the most frequent heights: from within a floor or ceiling, its returns would all have one
/// elevation.
Points without_floor_and_ceiling(Points points) {
  constexpr float kBin_m = 0.2F;
  constexpr double kMinShare = 0.1;
  for (int plane = 0; plane < 2; ++plane) {
    std::map<long, std::size_t> heights;
    for (const Eigen::Vector3f& point : points) ++heights[std::lround(point.z() / kBin_m)];
    const auto most = std::max_element(heights.begin(), heights.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto count = static_cast<double>(most->second), all = static_cast<double>(points.size());
    if (count < kMinShare * all || count > (1 - kMinShare) * all) break;
    const float height_m = kBin_m * static_cast<float>(most->first);
    std::erase_if(points, [&](const Eigen::Vector3f& p) { return std::abs(p.z() - height_m) <= kBin_m; });
  }
  return points;
}

/// Its height first, which the beams near the horizon show wherever else it is.
Eigen::Vector3d origin_of_rings(const Points& all) {
  const Points points = without_floor_and_ceiling(all);
  if (points.empty()) return Eigen::Vector3d::Zero();
  constexpr double kStep_m = 0.02, kFineStep_m = 0.005;
  const Eigen::Vector3d body = Eigen::Vector3d::Zero();
  Eigen::Vector3d origin = body;
  search(points, origin, 2, kMaxHeight_m, kStep_m);
  for (const int axis : {0, 1}) search(points, origin, axis, kMaxOffset_m, kStep_m);
  for (const int axis : {2, 0, 1}) search(points, origin, axis, kStep_m, kFineStep_m);
  return entropy(points, origin) < entropy(points, body) - kMinGain ? origin : body;
}

double ground_near(const Points& points, double scanner_z) {
  constexpr double kNear_m = 12, kBin_m = 0.1, kMinBelow_m = 0.1;
  std::map<long, int> heights;
  for (const Eigen::Vector3f& point : points)
    if (static_cast<double>(point.head<2>().norm()) < kNear_m &&
        static_cast<double>(point.z()) < scanner_z - kMinBelow_m)
      ++heights[std::lround(static_cast<double>(point.z()) / kBin_m)];
  if (heights.empty()) return std::min(0.0, scanner_z);
  const auto most = std::max_element(heights.begin(), heights.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return kBin_m * static_cast<double>(most->first);
}

}  // namespace

ScannerGeometry scanner_geometry(const LidarLog& log, ScannerKind kind, const ScanPointParams& params) {
  ScannerGeometry geometry;
  const Points points = some_points(log, params, geometry.returns_per_scan);
  if (points.empty()) return geometry;
  geometry.reach_m = reach_m(points);
  if (kind == ScannerKind::kPlanar) {
    std::vector<double> heights;
    for (const Eigen::Vector3f& point : points) heights.push_back(static_cast<double>(point.z()));
    geometry.scanner_m.z() = upper_median(std::move(heights));
    geometry.ground_m = std::min(0.0, geometry.scanner_m.z());
    return geometry;
  }
  geometry.scanner_m = origin_of_rings(points);
  geometry.ground_m = ground_near(points, geometry.scanner_m.z());
  return geometry;
}

}  // namespace radioslam
