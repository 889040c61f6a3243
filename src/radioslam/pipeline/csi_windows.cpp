#include "radioslam/pipeline/csi_windows.hpp"

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

std::vector<TimeWindow> pieces_of_way(const Trajectory<SE3>& odometry, const TimeWindow& during,
                                      double length_m, double least_m) {
  std::vector<Stamp> stamps;
  std::vector<double> way_m;
  const SE3* before = nullptr;
  for (const auto& [stamp, pose] : odometry) {
    if (stamp < during.begin || during.end < stamp) continue;
    way_m.push_back(way_m.empty() ? 0 : way_m.back() + distance_m(*before, pose));
    stamps.push_back(stamp);
    before = &pose;
  }
  std::vector<TimeWindow> pieces;
  if (way_m.empty() || way_m.back() < least_m) return pieces;
  const auto count = std::max<long>(1, std::lround(way_m.back() / length_m));
  const double each_m = way_m.back() / static_cast<double>(count);
  for (long piece = 0; piece < count; ++piece) {
    const auto at = [&](double metres) {
      const auto k = std::lower_bound(way_m.begin(), way_m.end(), metres * (1 - 1e-12)) - way_m.begin();
      return stamps[std::min(static_cast<std::size_t>(k), stamps.size() - 1)];
    };
    pieces.push_back({at(each_m * static_cast<double>(piece)), at(each_m * static_cast<double>(piece + 1))});
  }
  return pieces;
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
