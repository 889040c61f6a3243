// Trajectory: stamped poses of a robot, interpolated along geodesics.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/check.hpp"
#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// A body pose T_frame_body at a time; the frame is the trajectory's.
template <class Pose>
struct StampedPose {
  Stamp stamp;
  Pose pose;
};

/// Pose from a at fraction 0 to b at fraction 1 along the geodesic.
template <class Pose>
Pose interpolate(const Pose& a, const Pose& b, double fraction) {
  return a * Pose::exp(fraction * (a.inverse() * b).log());
}

/// Poses with strictly increasing stamps.
template <class Pose>
class Trajectory {
 public:
  Trajectory() = default;
  explicit Trajectory(std::vector<StampedPose<Pose>> poses) : poses_(std::move(poses)) {
    for (std::size_t i = 1; i < poses_.size(); ++i)
      RADIOSLAM_CHECK(poses_[i - 1].stamp < poses_[i].stamp, "trajectory stamps must increase");
  }

  bool empty() const { return poses_.empty(); }
  std::size_t size() const { return poses_.size(); }
  const StampedPose<Pose>& operator[](std::size_t i) const { return poses_[i]; }
  const StampedPose<Pose>& front() const { return poses_.front(); }
  const StampedPose<Pose>& back() const { return poses_.back(); }
  auto begin() const { return poses_.begin(); }
  auto end() const { return poses_.end(); }

  std::vector<Stamp> stamps() const {
    std::vector<Stamp> result;
    for (const auto& row : poses_) result.push_back(row.stamp);
    return result;
  }

  bool covers(Stamp stamp) const { return !empty() && front().stamp <= stamp && stamp <= back().stamp; }

  /// Index i with stamp(i) <= stamp < stamp(i + 1), clamped to [0, size - 2]; needs two poses.
  std::size_t segment(Stamp stamp) const {
    RADIOSLAM_CHECK(size() >= 2, "a segment needs two poses");
    const auto after = std::upper_bound(poses_.begin(), poses_.end(), stamp,
                                        [](Stamp s, const auto& p) { return s < p.stamp; });
    const auto i = after - poses_.begin();
    return static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(i - 1, 0, static_cast<std::ptrdiff_t>(size()) - 2));
  }

  /// The pose at `stamp`, by geodesic interpolation; nothing outside the time covered.
  std::optional<Pose> at(Stamp stamp) const {
    if (!covers(stamp)) return std::nullopt;
    if (size() == 1) return front().pose;
    const std::size_t i = segment(stamp);
    const auto& a = poses_[i];
    const auto& b = poses_[i + 1];
    const double fraction =
        static_cast<double>(stamp.ns - a.stamp.ns) / static_cast<double>(b.stamp.ns - a.stamp.ns);
    return interpolate(a.pose, b.pose, fraction);
  }

 private:
  std::vector<StampedPose<Pose>> poses_;
};

}  // namespace radioslam
