#include "radioslam/mission/keyframes.hpp"

#include <algorithm>

namespace radioslam {
namespace {

/// An odometry sample and its deviation from the geodesic, relative to the allowed one.
struct Deviation {
  std::size_t row = 0;
  double allowances = 0;
};

double allowances(double off, double allowed) { return allowed > 0 ? off / allowed : 0; }

Deviation largest_deviation(const Trajectory<SE3>& odometry, std::size_t first, std::size_t last,
                            const KeyframeParams& params) {
  const auto &a = odometry[first], &b = odometry[last];
  Deviation worst;
  for (std::size_t row = first + 1; row < last; ++row) {
    const double fraction = static_cast<double>(odometry[row].stamp.ns - a.stamp.ns) /
                            static_cast<double>(b.stamp.ns - a.stamp.ns);
    const SE3 off = interpolate(a.pose, b.pose, fraction).inverse() * odometry[row].pose;
    const double deviation = std::max(allowances(off.translation().norm(), params.max_deviation_m),
                                      allowances(off.log().tail<3>().norm(), params.max_deviation_rad));
    if (deviation > worst.allowances) worst = {row, deviation};
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

std::vector<std::size_t> refined_keyframes(const Trajectory<SE3>& odometry,
                                           const std::vector<std::size_t>& keyframes,
                                           const KeyframeParams& params) {
  std::vector<std::size_t> refined;  // keyframes up to the first interval still to be checked
  std::vector<std::size_t> ahead(keyframes.rbegin(), keyframes.rend());
  while (!ahead.empty()) {
    const Deviation deviation =
        refined.empty() ? Deviation{} : largest_deviation(odometry, refined.back(), ahead.back(), params);
    if (deviation.allowances > 1) {
      ahead.push_back(deviation.row);
    } else {
      refined.push_back(ahead.back());
      ahead.pop_back();
    }
  }
  return refined;
}

std::vector<std::size_t> causal_keyframes(const Trajectory<SE3>& odometry, const KeyframeParams& params) {
  std::vector<std::size_t> keyframes;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    if (!keyframes.empty() && keyframes.back() + 1 < i &&
        largest_deviation(odometry, keyframes.back(), i, params).allowances > 1)
      keyframes.push_back(i - 1);
    if (keyframes.empty() || i + 1 == odometry.size() ||
        is_new_keyframe(odometry[keyframes.back()].pose, odometry[i].pose, params))
      keyframes.push_back(i);
  }
  return keyframes;
}

std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp) {
  const auto after = std::upper_bound(keyframes.begin(), keyframes.end(), stamp);
  return after == keyframes.begin() ? 0 : static_cast<std::size_t>(after - keyframes.begin()) - 1;
}

}  // namespace radioslam
