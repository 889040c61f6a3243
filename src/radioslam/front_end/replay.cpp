#include "radioslam/front_end/replay.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

/// One kind of a robot's recordings.
struct Stream {
  std::vector<Stamp> stamps;  ///< at which they are known, in order
  std::function<Sample(std::size_t)> sample;
};

/// Of those that are kept, in the order in which they are known.
template <class Items, class Keep>
Stream stream_of(const Items& items, const Keep& keep) {
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
Stream stream_of(const Items& items) {
  return stream_of(items, [](const auto&) { return true; });
}

/// In the order in which samples of one stamp come.
std::vector<Stream> streams_of(const Mission& mission, RobotIndex self) {
  const Robot& robot = mission.robots[self.index()];
  const LidarLog& scans = robot.lidar;
  return {stream_of(robot.odometry),
          stream_of(robot.inertial),
          {scans.stamps,
           [&scans](std::size_t k) {
             return Sample(ScanSample{scans.stamps[k], scans.read(k)});
           }},
          stream_of(mission.ranges,
                    [&](const auto& range) { return range.i.robot == self || range.j.robot == self; }),
          stream_of(mission.aoa_measurements, [&](const auto& angles) { return angles.receiver == self; }),
          stream_of(robot.fixes),
          stream_of(robot.wifi),
          stream_of(mission.matches,
                    [&](const auto& match) { return match.robot_i == self || match.robot_j == self; })};
}

constexpr ReplayWindow kWhole{
    {std::numeric_limits<std::int64_t>::min()}, {std::numeric_limits<std::int64_t>::max()}, true};

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void number_keyframes(const FrontEnd& front_end, std::vector<ReplayedPose>& poses) {
  std::map<Stamp, std::uint32_t> numbers;
  for (const StampedPose<SE3>& keyframe : front_end.keyframes())
    numbers.emplace(keyframe.stamp, static_cast<std::uint32_t>(numbers.size()));
  for (ReplayedPose& pose : poses)
    if (const auto found = numbers.find(pose.pose.stamp); found != numbers.end())
      pose.keyframe = found->second;
}

}  // namespace

ReplayedRobot replay(const Mission& mission, RobotIndex self, const ReplayWindow& window,
                     const ScanParams& scans, const KeyframeParams& keyframes, CloudStore& clouds,
                     const Progress& progress) {
  const Robot& robot = mission.robots[self.index()];
  FrontEnd front_end(mission, self, {!robot.odometry.empty(), !robot.inertial.empty(), !robot.lidar.empty()},
                     scans, keyframes, clouds);
  const std::vector<Stream> streams = streams_of(mission, self);
  std::vector<std::size_t> next(streams.size(), 0);
  ReplayedRobot replayed;
  replayed.log.robot = robot.id;
  Stamp now;
  const auto take = [&](Clock::time_point begin) {
    for (OnlinePose& pose : front_end.take_poses())
      replayed.poses.push_back({pose, {}, seconds_between(pose.stamp, now), milliseconds_since(begin)});
    for (std::string& record : front_end.take_records()) {
      replayed.log.records.push_back(std::move(record));
      replayed.known.push_back(now);
    }
  };
  std::size_t total = 0, done = 0;
  for (const Stream& stream : streams) total += stream.stamps.size();
  for (; done < total; ++done) {
    std::size_t first = streams.size();
    for (std::size_t s = 0; s < streams.size(); ++s)
      if (next[s] < streams[s].stamps.size() &&
          (first == streams.size() || streams[s].stamps[next[s]] < streams[first].stamps[next[first]]))
        first = s;
    const Stamp stamp = streams[first].stamps[next[first]];
    const std::size_t number = next[first]++;
    if (stamp < window.begin || window.end < stamp) continue;
    Sample sample = streams[first].sample(number);
    now = stamp;
    const auto begin = Clock::now();
    front_end.add(std::move(sample));
    take(begin);
    report_progress(progress, "replay " + robot.id, static_cast<double>(done) / static_cast<double>(total));
  }
  const auto begin = Clock::now();
  if (!window.is_finished) now = window.end;
  replayed.tracked = front_end.finish();
  replayed.follows_scans = replayed.tracked.has_value();
  if (window.is_finished) take(begin);
  number_keyframes(front_end, replayed.poses);
  if (window.is_finished && replayed.tracked && !replayed.tracked->track.poses.empty()) {
    ScanTrajectory track;
    track.poses = replayed.tracked->track.poses;
    track.is_level = replayed.tracked->track.is_level;
    front_end.amend(odometry_from_scans(robot, track, scans.stage));
    take(begin);
  }
  replayed.events = front_end.events();
  replayed.left_out = front_end.left_out();
  return replayed;
}

std::vector<ReplayedRobot> replay(const Mission& mission, const ScanParams& scans,
                                  const KeyframeParams& keyframes, const Progress& progress) {
  std::mutex reporting;
  const Progress report = [&](std::string_view stage, double fraction) {
    const std::lock_guard lock(reporting);
    report_progress(progress, stage, fraction);
  };
  CloudStore clouds(scans.clouds);
  std::vector<ReplayedRobot> robots(mission.robots.size());
  parallel_for(robots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      robots[r] = replay(mission, RobotIndex(r), kWhole, scans, keyframes, clouds, report);
  });
  return robots;
}

}  // namespace radioslam
