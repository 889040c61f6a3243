#include "radioslam/cli/agent/front_end_thread.hpp"

#include <utility>

#include "radioslam/front_end/recorded_samples.hpp"

namespace radioslam::cli {

FrontEndThread::FrontEndThread(SampleSource& source, const RunParams& params,
                               const std::optional<LogBefore>& before, const MissionClock& clock,
                               Inbox& inbox, Poses poses)
    : source_(source),
      params_(params),
      before_(before),
      clock_(clock),
      inbox_(inbox),
      poses_(poses),
      clouds_(params.scans.clouds) {
  source_.set_say([this](std::string note) {
    FrontEndNews news;
    news.events.push_back({clock_.now(), std::move(note)});
    inbox_.push(std::move(news));
  });
  thread_ = std::thread([this] {
    try {
      run();
    } catch (...) {
      inbox_.push(std::current_exception());
    }
  });
}

FrontEndThread::~FrontEndThread() {
  conclude();
  thread_.join();
}

void FrontEndThread::run() {
  if (const auto sources = source_.begin()) {
    front_end_ = std::make_unique<FrontEnd>(source_.names(), source_.self(), *sources, params_.scans,
                                            params_.keyframe, clouds_);
    if (before_) resume();
    while (auto sample = source_.next()) {
      front_end_->add(*std::move(sample));
      report();
    }
    finish();
  }
  FrontEndNews last;
  last.is_over = true;
  inbox_.push(std::move(last));
}

void FrontEndThread::resume() {
  if (source_.odometry_goes_on() && front_end_->follows_scans())
    resumed_.emplace(before_->log,
                     OdometryBesideScans{before_->recorded, front_end_->recorded_at_keyframes(),
                                         source_.names().robots[source_.self().index()].odometry_noise});
  else
    resumed_.emplace(before_->log, source_.odometry_goes_on());
}

void FrontEndThread::finish() {
  const auto tracked = front_end_->finish();
  is_finished_ = true;
  FrontEndNews last;
  if (tracked) {
    add_clouds(tracked->track, tracked->track.keyframes.size(), last);
    if (tracked->traits)
      last.scanner = {tracked->traits->kind, tracked->track.nominal_inlier_ratio, tracked->traits->spacing_m};
    report();
    amend_with_hindsight(*front_end_, *tracked, source_.names().robots[source_.self().index()],
                         params_.scans.stage);
  }
  report(std::move(last));
}

/// Those of the first `until` keyframes that were not reported.
void FrontEndThread::add_clouds(const ScanTrajectory& track, std::size_t until, FrontEndNews& news) {
  std::size_t first = until;
  while (first > 0 && (!reported_cloud_ || track.poses[track.keyframes[first - 1]].stamp > *reported_cloud_))
    --first;
  for (std::size_t k = first; k < until; ++k) {
    reported_cloud_ = track.poses[track.keyframes[k]].stamp;
    news.clouds.emplace_back(*reported_cloud_, track.clouds[k]);
  }
}

/// Of the last keyframe that was said.
void FrontEndThread::add_recorded(FrontEndNews& news) {
  const auto& said = front_end_->keyframes();
  if (said.empty() || reported_recorded_ == said.back().stamp) return;
  const auto recorded = front_end_->recorded_at_keyframes().find(said.back().stamp);
  if (recorded == front_end_->recorded_at_keyframes().end()) return;
  reported_recorded_ = recorded->first;
  news.recorded = encode_recorded(*recorded);
}

void FrontEndThread::report(FrontEndNews news) {
  for (std::string& record : front_end_->take_records()) {
    if (!resumed_)
      news.records.push_back(std::move(record));
    else if (auto continued = resumed_->continued(record))
      news.records.push_back(*std::move(continued));
  }
  add_recorded(news);
  for (const OnlinePose& pose : front_end_->take_poses())
    if (poses_ == Poses::kReported) news.poses.push_back(source_.published(pose));
  const ScanTrajectory* track = is_finished_ ? nullptr : front_end_->scans().track();
  const auto& traits = front_end_->scans().traits();
  // The scan of the newest pose may be another one yet: one that starts a map is deskewed again.
  if (track && traits && track->poses.size() > 1) {
    const bool is_newest = track->keyframes.back() + 1 == track->poses.size();
    add_clouds(*track, track->keyframes.size() - (is_newest ? 1 : 0), news);
    if (!news.clouds.empty() && !news.scanner)
      news.scanner = {traits->kind,
                      track->nominal_inlier_ratio / static_cast<double>(track->poses.size() - 1),
                      traits->spacing_m};
  }
  auto events = front_end_->events();
  for (; reported_events_ < events.size(); ++reported_events_)
    news.events.push_back(std::move(events[reported_events_]));
  if (!news.empty()) inbox_.push(std::move(news));
}

}  // namespace radioslam::cli
