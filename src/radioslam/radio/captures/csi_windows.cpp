#include "radioslam/radio/captures/csi_windows.hpp"

#include <algorithm>
#include <cmath>

namespace radioslam {
namespace {

double distance_m(const SE3& a, const SE3& b) { return (a.translation() - b.translation()).norm(); }

}  // namespace

std::vector<TimeWindow> still_times(const Trajectory<SE3>& odometry, double reach_m) {
  std::vector<TimeWindow> times;
  for (std::size_t first = 0; first < odometry.size();) {
    std::size_t last = first;
    while (last + 1 < odometry.size() && distance_m(odometry[first].pose, odometry[last + 1].pose) <= reach_m)
      ++last;
    if (last > first) times.push_back({odometry[first].stamp, odometry[last].stamp});
    first = last + 1;
  }
  return times;
}

std::vector<TimeWindow> path_windows(const Trajectory<SE3>& odometry, const TimeWindow& during,
                                     double length_m, double min_m) {
  std::vector<Stamp> stamps;
  std::vector<double> path_m;
  const SE3* before = nullptr;
  for (const auto& [stamp, pose] : odometry) {
    if (stamp < during.begin || during.end < stamp) continue;
    path_m.push_back(path_m.empty() ? 0 : path_m.back() + distance_m(*before, pose));
    stamps.push_back(stamp);
    before = &pose;
  }
  std::vector<TimeWindow> windows;
  if (path_m.empty() || path_m.back() < min_m) return windows;
  const auto count = std::max<long>(1, std::lround(path_m.back() / length_m));
  const double each_m = path_m.back() / static_cast<double>(count);
  for (long n = 0; n < count; ++n) {
    const auto at = [&](double metres) {
      const auto k = std::lower_bound(path_m.begin(), path_m.end(), metres * (1 - 1e-12)) - path_m.begin();
      return stamps[std::min(static_cast<std::size_t>(k), stamps.size() - 1)];
    };
    windows.push_back({at(each_m * static_cast<double>(n)), at(each_m * static_cast<double>(n + 1))});
  }
  return windows;
}

std::vector<TimeWindow> turns_of(const Trajectory<SE3>& odometry, double turn_rad) {
  std::vector<TimeWindow> turns;
  double turned_rad = 0;
  std::size_t first = 0;
  for (std::size_t k = 1; k < odometry.size(); ++k) {
    turned_rad += odometry[k - 1].pose.rotation().angularDistance(odometry[k].pose.rotation());
    if (turned_rad < turn_rad) continue;
    turns.push_back({odometry[first].stamp, odometry[k].stamp});
    turned_rad = 0;
    first = k;
  }
  return turns;
}

}  // namespace radioslam
