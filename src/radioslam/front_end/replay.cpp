#include "radioslam/front_end/replay.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/front_end/recorded_samples.hpp"

namespace radioslam {
namespace {

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
  FrontEnd front_end(mission, self, sources_of(robot), scans, keyframes, clouds);
  RecordedSamples samples(mission, self);
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
  samples.skip_before(window.begin);
  while (const auto stamp = samples.next()) {
    if (window.end < *stamp) break;
    Sample sample = samples.take();
    now = *stamp;
    const auto begin = Clock::now();
    front_end.add(std::move(sample));
    take(begin);
    report_progress(progress, "replay " + robot.id, samples.share_taken());
  }
  const auto begin = Clock::now();
  if (!window.is_finished) now = window.end;
  replayed.tracked = front_end.finish();
  replayed.follows_scans = front_end.follows_scans();
  replayed.recorded = front_end.recorded_at_keyframes();
  if (window.is_finished) take(begin);
  number_keyframes(front_end, replayed.poses);
  if (window.is_finished && replayed.tracked) {
    amend_with_hindsight(front_end, *replayed.tracked, robot, scans.stage);
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
