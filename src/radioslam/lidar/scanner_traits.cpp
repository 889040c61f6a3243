#include "radioslam/lidar/scanner_traits.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "radioslam/base/statistics.hpp"
#include "radioslam/lidar/scan_points.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kTraitScans = 10;
constexpr float kFlat_m = 1e-3F;

}  // namespace

ScannerTraits scanner_traits(const LidarLog& log, const LidarParams& params) {
  std::vector<double> ranges;
  ScannerTraits traits;
  traits.kind = ScannerKind::kPlanar;
  const std::size_t stride = std::max<std::size_t>(1, (log.size() + kTraitScans - 1) / kTraitScans);
  for (std::size_t k = 0; k < log.size(); k += stride) {
    const auto points = filter_and_deskew(log.read(k), SE3::Tangent::Zero(), params.points).points;
    for (const Eigen::Vector3f& point : points) {
      ranges.push_back(static_cast<double>(point.norm()));
      if (std::abs(point.z() - points.front().z()) > kFlat_m) traits.kind = ScannerKind::kSpatial;
    }
  }
  const LidarOdometryParams& odometry = params.odometry;
  traits.spacing_m = odometry.spacing_m > 0 ? odometry.spacing_m
                     : ranges.empty()       ? odometry.max_spacing_m
                                            : std::clamp(odometry.spacing_ratio * upper_median(ranges),
                                                         odometry.min_spacing_m, odometry.max_spacing_m);
  return traits;
}

}  // namespace radioslam
