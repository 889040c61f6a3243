#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/text.hpp"
#include "radioslam/mission/sweep_slices.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kSampledScans = 8;
constexpr std::size_t kScansToFindSlices = 10;
constexpr double kMaxMedianRange_m = 300;

std::vector<double> ranges_m(const LidarScan& scan) {
  std::vector<double> ranges;
  for (const Eigen::Vector3f& point : scan.points) {
    const double range = static_cast<double>(point.norm());
    if (range > 0 && range < 1e9) ranges.push_back(range);  // false for NaN
  }
  return ranges;
}

bool same_points(const LidarScan& a, const LidarScan& b) {
  return a.points.size() > 20 &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const auto& x, const auto& y) { return x == y || (!(x == x) && !(y == y)); });
}

/// Whether the robot's first scans are slices of sweeps.
std::optional<SliceMotion> motion_of_first_scans(const Robot& robot) {
  std::vector<StampedScan> first;
  for (std::size_t k = 0; k < std::min(robot.lidar.size(), kScansToFindSlices); ++k)
    first.push_back({robot.lidar.stamps[k], robot.lidar.read(k)});
  return motion_of_slices(first);
}

void check_robot(const Robot& robot, std::vector<Finding>& findings) {
  const std::size_t count = std::min(robot.lidar.size(), kSampledScans);
  if (count < 2) return;
  const std::string folder = robot_file(robot.id, "lidar");
  std::vector<double> medians;
  std::size_t repeated = 0, few = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = k * (robot.lidar.size() - 1) / count;
    const LidarScan scan = robot.lidar.read(at);
    repeated += same_points(scan, robot.lidar.read(at + 1));
    const auto ranges = ranges_m(scan);
    if (ranges.size() < 20) ++few;
    if (!ranges.empty()) medians.push_back(median(ranges));
  }
  if (few == count)
    findings.push_back({"too-little", Severity::kWarning, robot.id, folder, "scans of fewer than 20 points",
                        "scans that can be registered", "check the format of the scans"});
  const double typical = medians.empty() ? 1 : median(medians);
  if (typical > kMaxMedianRange_m || typical < 0.05)
    findings.push_back({"unit", Severity::kError, robot.id, folder,
                        "the median range of the points is " + number(typical) + " m", "metres",
                        typical > 1 ? "divide the coordinates by 1000 if they are in millimetres"
                                    : "multiply the coordinates by 1000 if they are in kilometres"});
  if (const auto slices = motion_of_first_scans(robot))
    findings.push_back({"slices", Severity::kWarning, robot.id, folder,
                        "the scans are slices of " + number(std::abs(degrees(slices->step_rad))) +
                            " degrees, each next to the one before",
                        "whole sweeps", "join the slices of a sweep; `radioslam import rosbag` does"});
  if (2 * repeated >= count)
    findings.push_back(
        {"stale", Severity::kWarning, robot.id, folder,
         std::to_string(repeated) + " of " + std::to_string(count) + " sampled scans are equal to the next",
         "a new measurement in every scan", "remove repeated scans"});
}

}  // namespace

std::vector<Finding> check_scans(const Mission& mission) {
  std::vector<Finding> findings;
  for (const Robot& robot : mission.robots) check_robot(robot, findings);
  return findings;
}

}  // namespace radioslam
