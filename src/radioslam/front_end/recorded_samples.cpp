#include "radioslam/front_end/recorded_samples.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {

/// Of those that are kept.
template <class Items, class Keep>
RecordedSamples::Stream RecordedSamples::stream_of(const Items& items, const Keep& keep) {
  std::vector<std::pair<Stamp, std::size_t>> kept;
  for (std::size_t k = 0; k < items.size(); ++k)
    if (keep(items[k])) kept.emplace_back(stamp_of(Sample(items[k])), k);
  std::sort(kept.begin(), kept.end());
  std::vector<Stamp> stamps;
  for (const auto& [stamp, k] : kept) stamps.push_back(stamp);
  return {std::move(stamps),
          [&items, kept = std::move(kept)](std::size_t n) { return Sample(items[kept[n].second]); }};
}

template <class Items>
RecordedSamples::Stream RecordedSamples::stream_of(const Items& items) {
  return stream_of(items, [](const auto&) { return true; });
}

/// In the order in which samples of one stamp come.
std::vector<RecordedSamples::Stream> RecordedSamples::streams_of(const Mission& mission, RobotIndex self) {
  const Robot& robot = mission.robots[self.index()];
  const LidarLog& scans = robot.lidar;
  return {stream_of(robot.odometry),
          stream_of(robot.inertial),
          {scans.stamps,
           [&scans](std::size_t k) {
             return Sample(ScanSample{scans.stamps[k], scans.read(k)});
           }},
          stream_of(mission.ranges,
                    [self](const auto& range) { return range.i.robot == self || range.j.robot == self; }),
          stream_of(mission.aoa_measurements, [self](const auto& angles) { return angles.receiver == self; }),
          stream_of(robot.fixes),
          stream_of(robot.wifi),
          stream_of(mission.matches,
                    [self](const auto& match) { return match.robot_i == self || match.robot_j == self; })};
}

RecordedSamples::RecordedSamples(const Mission& mission, RobotIndex self)
    : streams_(streams_of(mission, self)) {
  for (const Stream& stream : streams_) total_ += stream.stamps.size();
}

/// The stream of the next sample.
std::size_t RecordedSamples::first() const {
  std::size_t first = streams_.size();
  for (std::size_t s = 0; s < streams_.size(); ++s)
    if (!streams_[s].is_over() &&
        (first == streams_.size() ||
         streams_[s].stamps[streams_[s].taken] < streams_[first].stamps[streams_[first].taken]))
      first = s;
  return first;
}

std::optional<Stamp> RecordedSamples::next() const {
  const std::size_t s = first();
  if (s == streams_.size()) return std::nullopt;
  return streams_[s].stamps[streams_[s].taken];
}

Sample RecordedSamples::take() {
  Stream& stream = streams_[first()];
  ++taken_;
  return stream.sample(stream.taken++);
}

void RecordedSamples::skip_before(Stamp begin) {
  for (Stream& stream : streams_)
    for (; !stream.is_over() && stream.stamps[stream.taken] < begin; ++stream.taken) ++taken_;
}

MotionSources sources_of(const Robot& robot) {
  return {!robot.odometry.empty(), !robot.inertial.empty(), !robot.lidar.empty()};
}

void amend_with_hindsight(FrontEnd& front_end, const TrackedScans& tracked, const Robot& robot,
                          const ScanStageParams& params) {
  if (tracked.track.poses.empty()) return;
  front_end.amend(odometry_from_scans(robot, tracked.track, params));
}

}  // namespace radioslam
