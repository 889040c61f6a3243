#include "radioslam/odometry/motion_prior.hpp"

#include <algorithm>

namespace radioslam {

double max_sample_gap_s(const Trajectory<SE3>& samples, Stamp begin, Stamp end) {
  double max_s = 0;
  if (samples.size() < 2) return max_s;
  for (std::size_t k = samples.segment(begin); k + 1 < samples.size() && samples[k].stamp < end; ++k)
    max_s = std::max(max_s, seconds_between(samples[k].stamp, samples[k + 1].stamp));
  return max_s;
}

std::optional<MotionPrior> prior_from_odometry(const Trajectory<SE3>& odometry, std::optional<Stamp> previous,
                                               Stamp stamp, const ScanTimeSpan& time, double max_gap_s) {
  const auto at = [&](double after_s) { return Stamp{stamp.ns + Stamp::from_seconds(after_s).ns}; };
  const Stamp begin = std::min({stamp, previous.value_or(stamp), at(time.first_s)});
  const Stamp end = std::max(stamp, at(time.last_s));
  if (!odometry.covers(begin) || !odometry.covers(end)) return std::nullopt;
  if (max_sample_gap_s(odometry, begin, end) > max_gap_s) return std::nullopt;
  const SE3 T_body_any = odometry.at(stamp)->inverse();
  MotionPrior prior{MotionSource::kOdometry, {}, ScanMotion::over(time)};
  ScanMotion& motion = prior.scan_motion;
  for (std::size_t k = 0; k < motion.poses.size(); ++k)
    motion.poses[k] = T_body_any * *odometry.at(at(motion.time_of(k)));
  if (previous) prior.T_previous_body = (T_body_any * *odometry.at(*previous)).inverse();
  return prior;
}

}  // namespace radioslam
