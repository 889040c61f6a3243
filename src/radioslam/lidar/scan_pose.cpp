#include "radioslam/lidar/scan_pose.hpp"

#include <utility>

namespace radioslam {

Trajectory<SE3> trajectory_of(const std::vector<ScanPose>& scans) {
  std::vector<StampedPose<SE3>> poses;
  for (const ScanPose& scan : scans) poses.push_back({scan.stamp, scan.T_start_body});
  return Trajectory<SE3>(std::move(poses));
}

}  // namespace radioslam
