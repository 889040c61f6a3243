#include "radioslam/pipeline/swept_way.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "radioslam/base/median.hpp"

namespace radioslam {
namespace {

bool is_possible_time(float time_s, const ScanPointParams& params) {
  return std::abs(static_cast<double>(time_s)) <= params.most_time_s;  // not where it is no number
}

}  // namespace

SweptTime swept_time(const LidarScan& scan, const ScanPointParams& params) {
  std::vector<double> times_s;
  for (const float time_s : scan.times_s)
    if (is_possible_time(time_s, params)) times_s.push_back(static_cast<double>(time_s));
  if (times_s.empty()) return {};
  const auto [first, last] = std::minmax_element(times_s.begin(), times_s.end());
  SweptTime time{*first, 0, *last};
  time.middle_s = upper_median(std::move(times_s));
  return time;
}

SweptWay SweptWay::over(const SweptTime& time) {
  constexpr std::size_t kPoses = 257;
  return {time, std::vector<SE3>(time.first_s < time.last_s ? kPoses : 1)};
}

double SweptWay::time_of(std::size_t k) const {
  const auto steps = static_cast<double>(std::max<std::size_t>(1, poses.size() - 1));
  return time.first_s + (time.last_s - time.first_s) * static_cast<double>(k) / steps;
}

std::size_t SweptWay::nearest(double time_s) const {
  const double length_s = time.last_s - time.first_s;
  if (length_s <= 0) return 0;
  const double share = std::clamp((time_s - time.first_s) / length_s, 0.0, 1.0);
  return static_cast<std::size_t>(std::lround(share * static_cast<double>(poses.size() - 1)));
}

LidarScan unbent(LidarScan scan, const SweptWay& way, const ScanPointParams& params) {
  if (scan.times_s.empty()) return scan;
  std::vector<Eigen::Isometry3f> carry;
  for (const SE3& pose : way.poses) {
    carry.push_back(Eigen::Isometry3f::Identity());
    carry.back().linear() = pose.rotation_matrix().cast<float>();
    carry.back().translation() = pose.translation().cast<float>();
  }
  const auto near = static_cast<float>(params.least_range_m);
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    Eigen::Vector3f& point = scan.points[k];
    if (!is_possible_time(scan.times_s[k], params))
      point.setConstant(std::numeric_limits<float>::quiet_NaN());
    else if (point.norm() >= near)
      point = carry[way.nearest(static_cast<double>(scan.times_s[k]))] * point;
  }
  scan.times_s.clear();
  return scan;
}

}  // namespace radioslam
