#include "radioslam/front_end/front_end.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace radioslam {
namespace {

constexpr std::size_t kMostRecorded = 4096;  // rows without a keyframe

/// The robot with the noise that its log states: none where scans measure it.
Robot of_log(const Robot& robot, bool follows_scans) {
  Robot properties = robot;
  properties.wifi.clear();
  properties.fixes.clear();
  properties.csi.reset();
  properties.keyframes.clear();
  if (follows_scans) properties.odometry_noise = {0, 0, 0, 0, 0, 0, {}};
  return properties;
}

}  // namespace

Stamp stamp_of(const Sample& sample) {
  if (const auto* match = std::get_if<PoseMatch>(&sample)) return std::max(match->stamp_i, match->stamp_j);
  return std::visit(
      [](const auto& of) {
        if constexpr (requires { of.stamp; })
          return of.stamp;
        else
          return Stamp{};
      },
      sample);
}

FrontEnd::FrontEnd(const Mission& names, RobotIndex self, MotionSources sources, const ScanParams& scans,
                   const KeyframeParams& keyframes, CloudStore& clouds)
    : self_(self),
      params_(scans),
      keyframe_params_(keyframes),
      follows_scans_(sources.scans &&
                     !(odometry_source(scans.stage) == OdometrySource::kRecorded && sources.odometry)),
      history_(of_log(names.robots[self.index()], follows_scans_)),
      scans_(names.robots[self.index()], sources, params_, keyframe_params_, clouds),
      log_(names, history_.robot(), keyframe_params_) {}

void FrontEnd::add(Sample sample) {
  const Stamp stamp = stamp_of(sample);
  const std::size_t kind = sample.index();
  if (released_ && stamp < *released_) {
    ++late_;
    if (!std::exchange(is_late_said_[kind], true))
      late_events_.push_back({*newest_, std::string(kSampleNames[kind]) +
                                            " come more than 0.3 s after later samples and are left out"});
    return;
  }
  waiting_.emplace(std::tuple(stamp, kind, counter_++), std::move(sample));
  newest_ = std::max(newest_.value_or(stamp), stamp);
  const Stamp until{newest_->ns - Stamp::from_seconds(kLate_s).ns};
  while (!waiting_.empty() && std::get<0>(waiting_.begin()->first) < until) {
    take(std::move(waiting_.extract(waiting_.begin()).mapped()));
    released_ = until;
  }
}

std::optional<TrackedScans> FrontEnd::finish() {
  while (!waiting_.empty()) take(std::move(waiting_.extract(waiting_.begin()).mapped()));
  released_ = newest_;
  std::optional<TrackedScans> tracked;
  if (follows_scans_) {
    scans_.register_waiting();
    follow_scans();
    tracked = scans_.finish();
  }
  log_.finish();
  note_recorded();
  return tracked;
}

std::vector<OnlinePose> FrontEnd::take_poses() { return std::exchange(poses_, {}); }

std::vector<FrontEndEvent> FrontEnd::events() const {
  std::vector<FrontEndEvent> all = scans_.events();
  all.insert(all.end(), late_events_.begin(), late_events_.end());
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return all;
}

void FrontEnd::take(Sample sample) {
  std::visit(
      [&](auto& of) {
        using Kind = std::decay_t<decltype(of)>;
        if constexpr (std::is_same_v<Kind, StampedPose<SE3>>) {
          if (follows_scans_) {
            scans_.add(of);
            recorded_.push_back(of);
            if (recorded_.size() > kMostRecorded) recorded_.pop_front();
          } else {
            add_pose(of.stamp, of.pose, nullptr);
          }
        } else if constexpr (std::is_same_v<Kind, ImuSample>) {
          if (follows_scans_) scans_.add(of);
        } else if constexpr (std::is_same_v<Kind, ScanSample>) {
          if (follows_scans_) scans_.add(of.stamp, std::move(of.scan));
        } else if constexpr (std::is_same_v<Kind, RangeMeasurement> || std::is_same_v<Kind, PoseMatch>) {
          log_.add(of, self_);
        } else {
          log_.add(of);
        }
      },
      sample);
  if (follows_scans_) follow_scans();
}

/// Says the poses of scans that have been registered since.
void FrontEnd::follow_scans() {
  const ScanTrajectory* track = scans_.track();
  if (!track) return;
  const auto later =
      std::upper_bound(track->poses.begin(), track->poses.end(),
                       latest_ ? latest_->stamp : Stamp{std::numeric_limits<std::int64_t>::min()},
                       [](Stamp at, const ScanPose& scan) { return at < scan.stamp; });
  for (auto k = static_cast<std::size_t>(later - track->poses.begin()); k < track->poses.size(); ++k)
    add_pose_of(*track, k);
  if (auto again = scans_.revised()) amend(odometry_from_scans(Robot(), *again, params_.stage));
}

/// By its motion since the scan before: what was said does not jump where the track is another one.
void FrontEnd::add_pose_of(const ScanTrajectory& track, std::size_t k) {
  const ScanPose& scan = track.poses[k];
  SE3 pose = scan.T_start_body;
  if (latest_) {
    const SE3 before = k > 0 ? track.poses[k - 1].T_start_body : scan.T_start_body;
    pose = latest_->pose * (before.inverse() * scan.T_start_body);
  } else if (!recorded_.empty()) {
    pose = recorded_.back().pose;
  }
  if (std::binary_search(track.keyframes.begin(), track.keyframes.end(), k)) log_.add_keyframe(scan.stamp);
  add_pose(scan.stamp, pose, &scan.covariance);
}

/// At the keyframes that were said since the last call.
void FrontEnd::note_recorded() {
  const auto& said = log_.said();
  for (; noted_ < said.size(); ++noted_) {
    const Stamp at = said[noted_].stamp;
    const auto after =
        std::find_if(recorded_.begin(), recorded_.end(), [&](const auto& row) { return at <= row.stamp; });
    if (after == recorded_.end() || (after == recorded_.begin() && at < after->stamp)) continue;
    const Trajectory<SE3> around(at == after->stamp ? std::vector{*after}
                                                    : std::vector{*std::prev(after), *after});
    recorded_at_keyframes_[at] = *around.at(at);
  }
  if (said.empty()) return;
  while (recorded_.size() > 1 && recorded_[1].stamp <= said.back().stamp) recorded_.pop_front();
}

void FrontEnd::add_pose(Stamp stamp, const SE3& pose, const SE3::Jacobian* covariance) {
  if (latest_ && covariance)
    history_.add(
        OdometryStepNoise{latest_->stamp, stamp, *covariance / seconds_between(latest_->stamp, stamp)});
  history_.add(StampedPose<SE3>{stamp, pose});
  history_.update();
  latest_ = {stamp, pose};
  poses_.push_back({stamp, pose});
  log_.add(*latest_);
  if (!log_.said().empty()) history_.forget_before(log_.said().back().stamp);
  if (follows_scans_) note_recorded();
}

}  // namespace radioslam
