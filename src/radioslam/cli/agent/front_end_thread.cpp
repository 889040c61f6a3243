#include "radioslam/cli/agent/paced_front_end.hpp"

#include <utility>

#include "radioslam/front_end/recorded_samples.hpp"

namespace radioslam::cli {

PacedFrontEnd::PacedFrontEnd(const Mission& mission, RobotIndex self, const RunParams& params,
                             const std::optional<KnownLog>& before, const MissionClock& clock, Inbox& inbox)
    : mission_(mission),
      self_(self),
      params_(params),
      clock_(clock),
      inbox_(inbox),
      clouds_(params.scans.clouds),
      front_end_(mission, self, sources_of(mission.robots[self.index()]), params.scans, params.keyframe,
                 clouds_) {
  if (before) resumed_.emplace(*before, !front_end_.follows_scans());
  thread_ = std::thread([this] {
    try {
      run();
    } catch (...) {
      inbox_.push(std::current_exception());
    }
  });
}

PacedFrontEnd::~PacedFrontEnd() {
  conclude();
  thread_.join();
}

void PacedFrontEnd::conclude() {
  const std::lock_guard lock(mutex_);
  is_concluded_ = true;
  concluded_.notify_all();
}

/// False if the recording ends before.
bool PacedFrontEnd::wait_until(Stamp stamp) {
  std::unique_lock lock(mutex_);
  return !concluded_.wait_until(lock, clock_.when(stamp), [this] { return is_concluded_; });
}

void PacedFrontEnd::run() {
  RecordedSamples samples(mission_, self_);
  if (resumed_) samples.skip_before(clock_.now());
  while (const auto stamp = samples.next()) {
    if (!wait_until(*stamp)) break;
    front_end_.add(samples.take());
    report();
  }
  const auto tracked = front_end_.finish();
  is_finished_ = true;
  FrontEndNews last;
  if (tracked) {
    add_clouds(tracked->track, tracked->track.keyframes.size(), last);
    if (tracked->traits)
      last.scanner = {tracked->traits->kind, tracked->track.nominal_inlier_ratio, tracked->traits->spacing_m};
    report();
    amend_with_hindsight(front_end_, *tracked, mission_.robots[self_.index()], params_.scans.stage);
  }
  last.is_over = true;
  report(std::move(last));
}

/// Those of the first `until` keyframes that were not reported.
void PacedFrontEnd::add_clouds(const ScanTrajectory& track, std::size_t until, FrontEndNews& news) {
  std::size_t first = until;
  while (first > 0 && (!reported_cloud_ || track.poses[track.keyframes[first - 1]].stamp > *reported_cloud_))
    --first;
  for (std::size_t k = first; k < until; ++k) {
    reported_cloud_ = track.poses[track.keyframes[k]].stamp;
    news.clouds.emplace_back(*reported_cloud_, track.clouds[k]);
  }
}

void PacedFrontEnd::report(FrontEndNews news) {
  for (std::string& record : front_end_.take_records()) {
    if (!resumed_)
      news.records.push_back(std::move(record));
    else if (auto continued = resumed_->continued(record))
      news.records.push_back(*std::move(continued));
  }
  front_end_.take_poses();
  const ScanTrajectory* track = is_finished_ ? nullptr : front_end_.scans().track();
  const auto& traits = front_end_.scans().traits();
  // The scan of the newest pose may be another one yet: one that starts a map is deskewed again.
  if (track && traits && track->poses.size() > 1) {
    const bool is_newest = track->keyframes.back() + 1 == track->poses.size();
    add_clouds(*track, track->keyframes.size() - (is_newest ? 1 : 0), news);
    if (!news.clouds.empty() && !news.scanner)
      news.scanner = {traits->kind,
                      track->nominal_inlier_ratio / static_cast<double>(track->poses.size() - 1),
                      traits->spacing_m};
  }
  auto events = front_end_.events();
  for (; reported_events_ < events.size(); ++reported_events_)
    news.events.push_back(std::move(events[reported_events_]));
  if (!news.empty()) inbox_.push(std::move(news));
}

}  // namespace radioslam::cli
