#include "radioslam/lidar/scan_gap.hpp"

#include <algorithm>

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

}  // namespace radioslam
