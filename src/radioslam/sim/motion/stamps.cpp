#include "radioslam/sim/motion/stamps.hpp"

#include <cmath>

#include "radioslam/base/units.hpp"

namespace radioslam {

std::vector<Stamp> regular_stamps(double begin_s, double end_s, double rate_hz) {
  std::vector<Stamp> stamps;
  for (int k = 0; begin_s + k / rate_hz <= end_s; ++k) {
    const auto ms = static_cast<std::int64_t>(std::llround((begin_s + k / rate_hz) * kMillisecondsPerSecond));
    stamps.push_back({ms * kNanosecondsPerMillisecond});
  }
  return stamps;
}

Trajectory<SE3> lifted(const std::vector<Stamp>& stamps, const std::vector<SE2>& poses) {
  std::vector<StampedPose<SE3>> stamped;
  for (std::size_t i = 0; i < stamps.size(); ++i) stamped.push_back({stamps[i], lift(poses[i])});
  return Trajectory<SE3>(std::move(stamped));
}

std::string robot_id(std::size_t index) {
  const std::string letter(1, static_cast<char>('a' + index % 26));
  return index < 26 ? letter : letter + std::to_string(index / 26);
}

}  // namespace radioslam
