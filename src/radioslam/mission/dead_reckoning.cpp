#include "radioslam/mission/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

/// Heading over time, from the frame's x axis.
class Headings {
 public:
  Headings(const std::vector<LevelSample>& motion, const std::optional<CompassFit>& compass)
      : motion_(motion) {
    for (const auto& sample : motion)
      heading_.push_back(sample.heading_rad + (compass ? compass->correction_rad(sample.stamp) : 0));
  }

  /// Heading of the last sample at or before `stamp`; 0 without samples.
  double at(Stamp stamp) const {
    if (heading_.empty()) return 0;
    const std::size_t after = first_after(stamp);
    return heading_[after == 0 ? 0 : after - 1];
  }

  /// Circular mean of the headings between the stamps.
  double mean(Stamp begin, Stamp end) const {
    double c = std::cos(at(begin)), s = std::sin(at(begin));
    for (std::size_t i = first_after(begin); i < first_after(end); ++i) {
      c += std::cos(heading_[i]);
      s += std::sin(heading_[i]);
    }
    return std::atan2(s, c);
  }

 private:
  std::size_t first_after(Stamp stamp) const {
    const auto after = std::upper_bound(motion_.begin(), motion_.end(), stamp,
                                        [](Stamp s, const LevelSample& m) { return s < m.stamp; });
    return static_cast<std::size_t>(after - motion_.begin());
  }

  const std::vector<LevelSample>& motion_;
  std::vector<double> heading_;
};

/// Trajectory with poses at the beginning, at both ends of every step and at the end.
Trajectory<SE3> walk_along(const std::vector<Step>& steps, const Headings& headings, Stamp begin, Stamp end) {
  std::vector<StampedPose<SE3>> poses{{begin, lift(SE2({0, 0}, headings.at(begin)))}};
  Eigen::Vector2d position(0, 0);
  const auto append_pose = [&](Stamp stamp) {
    if (poses.back().stamp < stamp) poses.push_back({stamp, lift(SE2(position, headings.at(stamp)))});
  };
  for (const Step& step : steps) {
    if (step.begin < begin || end < step.end) continue;
    append_pose(step.begin);
    const double heading = headings.mean(step.begin, step.end);
    position += step.length_m * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    append_pose(step.end);
  }
  append_pose(end);
  return Trajectory<SE3>(std::move(poses));
}

}  // namespace

DeadReckoning dead_reckon(const PhoneMotion& motion, Stamp begin, Stamp end,
                          const DeadReckoningParams& params) {
  RADIOSLAM_CHECK(begin < end, "begin must precede end");
  const auto level = level_motion(motion, params.levelling);
  DeadReckoning walk;
  walk.steps = find_steps(level, params.steps);
  walk.compass = fit_compass(level, motion.orientation, params.compass);
  walk.odometry = walk_along(walk.steps, Headings(level, walk.compass), begin, end);
  return walk;
}

}  // namespace radioslam
