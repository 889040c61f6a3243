#include "radioslam/lidar/scan_pose.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {

bool ScanGapDetector::is_after_gap(Stamp stamp) {
  const double dt_s = newest_ ? seconds_between(*newest_, stamp) : 0;
  newest_ = stamp;
  if (dt_s <= 0) return false;
  const double max_s = interval_s_ > 0 ? params_.max_lost_scans * interval_s_ : dt_s;
  const double newest_ratio = interval_s_ > 0 ? params_.error_smoothing : 1;
  interval_s_ += newest_ratio * (std::min(dt_s, max_s) - interval_s_);
  return dt_s > max_s;
}

Trajectory<SE3> trajectory_of(const std::vector<ScanPose>& scans) {
  std::vector<StampedPose<SE3>> poses;
  for (const ScanPose& scan : scans) poses.push_back({scan.stamp, scan.T_start_body});
  return Trajectory<SE3>(std::move(poses));
}

}  // namespace radioslam
