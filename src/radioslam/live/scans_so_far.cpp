#include "radioslam/live/scans_so_far.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {

void LoggedKeyframes::add(const KeyframeRecord& keyframe) {
  const SE3 before = poses.empty() ? SE3() : poses.back().pose;
  if (!poses.empty()) step_covariances.push_back(keyframe.covariance.value_or(SE3::Jacobian::Zero()));
  poses.push_back({keyframe.stamp, before * keyframe.T_before_this});
}

ScansSoFar::ScansSoFar(const ReplayedRobot& robot) {
  if (!robot.tracked || robot.tracked->track.poses.empty() || !robot.tracked->traits) return;
  ScanTrajectory track = robot.tracked->track;
  for (const std::size_t k : track.keyframes) stamps_.push_back(track.poses[k].stamp);
  all_ = extract_keyframes(track, *robot.tracked->traits);
}

bool ScansSoFar::has_any(const LoggedKeyframes& known) const {
  return !stamps_.empty() && !known.poses.empty() && stamps_.front() <= known.poses.back().stamp;
}

ScanOdometry ScansSoFar::update(const LoggedKeyframes& known, const ScanLoopSearch& search,
                                const Progress& progress) {
  ScanOdometry scans;
  ScanKeyframes& of = scans.keyframes;
  of.nominal_inlier_ratio = all_.nominal_inlier_ratio;
  of.spacing_m = all_.spacing_m;
  of.kind = all_.kind;
  UncertainPose<SE3> step;
  std::size_t next = 0;
  for (std::size_t k = 0; k < known.poses.size(); ++k) {
    if (k > 0)
      step = step * UncertainPose<SE3>{known.poses[k - 1].pose.inverse() * known.poses[k].pose,
                                       known.step_covariances[k - 1]};
    while (next < stamps_.size() && stamps_[next] < known.poses[k].stamp) ++next;
    if (next == stamps_.size() || stamps_[next] != known.poses[k].stamp) continue;
    if (!of.poses.empty()) of.step_covariances.push_back(step.covariance);
    step = {};
    of.poses.push_back(known.poses[k].pose);
    of.clouds.push_back(all_.clouds[next]);
    scans.keyframe_stamps.push_back(stamps_[next]);
  }
  loops_ = close_scan_loops(of, search, progress, &loops_);
  if (!loops_.loops.empty()) scans.corrected = loops_.poses;
  return scans;
}

}  // namespace radioslam
