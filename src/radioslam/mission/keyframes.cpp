#include "radioslam/mission/keyframes.hpp"

#include <algorithm>

namespace radioslam {
namespace {

/// A row and how far it is from the geodesic, in allowances.
struct Bend {
  std::size_t row = 0;
  double allowances = 0;
};

double allowances(double off, double allowed) { return allowed > 0 ? off / allowed : 0; }

Bend worst_bend(const Trajectory<SE3>& odometry, std::size_t first, std::size_t last,
                const KeyframeParams& params) {
  const auto &a = odometry[first], &b = odometry[last];
  Bend worst;
  for (std::size_t row = first + 1; row < last; ++row) {
    const double share = static_cast<double>(odometry[row].stamp.ns - a.stamp.ns) /
                         static_cast<double>(b.stamp.ns - a.stamp.ns);
    const SE3 off = interpolate(a.pose, b.pose, share).inverse() * odometry[row].pose;
    const double bend = std::max(allowances(off.translation().norm(), params.bend_m),
                                 allowances(off.log().tail<3>().norm(), params.bend_rad));
    if (bend > worst.allowances) worst = {row, bend};
  }
  return worst;
}

}  // namespace

bool is_new_keyframe(const SE3& last, const SE3& pose, const KeyframeParams& params) {
  const SE3 step = last.inverse() * pose;
  return step.translation().norm() >= params.distance_m || step.log().tail<3>().norm() >= params.angle_rad;
}

std::vector<std::size_t> select_keyframes(const Trajectory<SE3>& odometry, const KeyframeParams& params) {
  std::vector<std::size_t> keyframes;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    if (keyframes.empty() || i + 1 == odometry.size()) {
      keyframes.push_back(i);
      continue;
    }
    if (is_new_keyframe(odometry[keyframes.back()].pose, odometry[i].pose, params)) keyframes.push_back(i);
  }
  return keyframes;
}

std::vector<std::size_t> with_bends(const Trajectory<SE3>& odometry,
                                    const std::vector<std::size_t>& keyframes, const KeyframeParams& params) {
  std::vector<std::size_t> straight;  // as far as the first of those still to be looked at
  std::vector<std::size_t> ahead(keyframes.rbegin(), keyframes.rend());
  while (!ahead.empty()) {
    const Bend bend = straight.empty() ? Bend{} : worst_bend(odometry, straight.back(), ahead.back(), params);
    if (bend.allowances > 1) {
      ahead.push_back(bend.row);
    } else {
      straight.push_back(ahead.back());
      ahead.pop_back();
    }
  }
  return straight;
}

std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp) {
  const auto after = std::upper_bound(keyframes.begin(), keyframes.end(), stamp);
  return after == keyframes.begin() ? 0 : static_cast<std::size_t>(after - keyframes.begin()) - 1;
}

}  // namespace radioslam
