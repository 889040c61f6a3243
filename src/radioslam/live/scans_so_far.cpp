#include "radioslam/live/scans_so_far.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {
namespace {

constexpr double kUnknownVariance = 1e4;
constexpr std::size_t kMostMissing = 64;  // keyframes that are numbered on

}  // namespace

void LoggedKeyframes::add(const KeyframeRecord& keyframe) {
  const SE3 before = said.empty() ? SE3() : said.back().pose;
  const bool is_near = keyframe.number < said.size() + kMostMissing;
  while (!said.empty() && is_near && said.size() < keyframe.number) {  // missing: the motion is not known
    said.push_back(said.back());
    steps.push_back({SE3(), kUnknownVariance * SE3::Jacobian::Identity()});
  }
  said.push_back({keyframe.stamp, before * keyframe.T_before_this});
  steps.push_back({keyframe.T_before_this, keyframe.covariance.value_or(SE3::Jacobian::Zero())});
}

void LoggedKeyframes::add(const AmendmentRecord& amendment) {
  for (std::size_t k = 0; k < amendment.steps.size() && amendment.first + k < steps.size(); ++k) {
    const AmendedStep& step = amendment.steps[k];
    steps[amendment.first + k] = {step.T_before_this, step.covariance.value_or(SE3::Jacobian::Zero())};
  }
}

ScansSoFar::ScansSoFar(const ReplayedRobot& robot) {
  if (!robot.tracked || robot.tracked->track.poses.empty() || !robot.tracked->traits) return;
  const ScanTrajectory& track = robot.tracked->track;
  std::vector<Stamp> stamps;
  for (const std::size_t k : track.keyframes) stamps.push_back(track.poses[k].stamp);
  const ScanKeyframes all = extract_keyframes(track, *robot.tracked->traits);
  scanner_ = {all.kind, all.nominal_inlier_ratio, all.spacing_m};
  for (std::size_t k = 0; k < stamps.size(); ++k) add(stamps[k], all.clouds[k]);
}

bool ScansSoFar::has_any(const LoggedKeyframes& known) const {
  return !clouds_.empty() && !known.said.empty() && clouds_.begin()->first <= known.said.back().stamp;
}

ScanOdometry ScansSoFar::among(const LoggedKeyframes& known, bool all) const {
  ScanOdometry scans;
  ScanKeyframes& of = scans.keyframes;
  of.nominal_inlier_ratio = scanner_.nominal_inlier_ratio;
  of.spacing_m = scanner_.spacing_m;
  of.kind = scanner_.kind;
  SE3 pose;
  UncertainPose<SE3> step;
  for (std::size_t k = 0; k < known.said.size(); ++k) {
    pose = pose * known.steps[k].pose;
    step = step * known.steps[k];
    const auto cloud = clouds_.find(known.said[k].stamp);
    if (cloud == clouds_.end() && !all) continue;
    if (!of.poses.empty()) of.step_covariances.push_back(step.covariance);
    step = {};
    of.poses.push_back(pose);
    of.clouds.push_back(cloud == clouds_.end() ? StoredCloud() : cloud->second);
    scans.keyframe_stamps.push_back(known.said[k].stamp);
  }
  return scans;
}

ScanOdometry ScansSoFar::update(const LoggedKeyframes& known, const ScanLoopSearch& search,
                                const Progress& progress) {
  ScanOdometry scans = among(known);
  loops_ = close_scan_loops(scans.keyframes, search, progress, &loops_);
  if (!loops_.loops.empty()) scans.corrected = loops_.poses;
  return scans;
}

void add_updated(ScansSoFar& scans, const LoggedKeyframes& known, const ScanLoopSearch& search,
                 const Progress& progress, MeasuredScans& measured) {
  const RobotIndex robot(measured.robots.size());
  const auto& of = measured.robots.emplace_back(scans.update(known, search, progress));
  for (const ScanLoop& loop : scans.loops().loops)
    measured.closures.push_back({robot, of->keyframe_stamps[loop.i], of->keyframe_stamps[loop.j], loop});
}

MeasuredScans measured_so_far(std::map<std::string, ScansSoFar>& scans, const std::vector<Robot>& robots,
                              const std::map<std::string, LoggedKeyframes>& keyframes,
                              const ScanLoopSearch& search, const Progress& progress) {
  MeasuredScans measured;
  for (const Robot& robot : robots) {
    const auto found = scans.find(robot.id);
    const LoggedKeyframes& known = keyframes.at(robot.id);
    if (found == scans.end() || !found->second.has_any(known))
      measured.robots.emplace_back();
    else
      add_updated(found->second, known, search, progress, measured);
  }
  return measured;
}

}  // namespace radioslam
