#include "radioslam/team/scripted_robots.hpp"

#include <algorithm>
#include <limits>

#include "radioslam/base/parallel.hpp"
#include "radioslam/front_end/replay.hpp"

namespace radioslam {
namespace {

ScriptedRun scripted(Stamp begin, const ReplayedRobot& replayed) {
  ScriptedRun run;
  run.begin = begin;
  run.follows_scans = replayed.follows_scans;
  run.recorded = replayed.recorded;
  for (std::size_t k = 0; k < replayed.known.size(); ++k)
    run.records.emplace_back(replayed.known[k], replayed.log.records[k]);
  const ScansSoFar scans(replayed);
  run.scanner = scans.scanner();
  run.clouds.assign(scans.clouds().begin(), scans.clouds().end());
  return run;
}

}  // namespace

Stamp begin_of(const Mission& mission) {
  std::optional<Stamp> begin;
  const auto note = [&](Stamp stamp) { begin = begin ? std::min(*begin, stamp) : stamp; };
  for (const Robot& robot : mission.robots) {
    if (!robot.odometry.empty()) note(robot.odometry.front().stamp);
    if (!robot.lidar.stamps.empty()) note(robot.lidar.stamps.front());
  }
  return begin.value_or(Stamp{});
}

Stamp end_of(const Mission& mission) {
  Stamp end = begin_of(mission);
  for (const Robot& robot : mission.robots) {
    if (!robot.odometry.empty()) end = std::max(end, robot.odometry.back().stamp);
    if (!robot.lidar.stamps.empty()) end = std::max(end, robot.lidar.stamps.back());
  }
  return end;
}

std::vector<ScriptedRobot> scripted_robots(const Mission& mission, const RunParams& params,
                                           const std::map<std::string, Kill>& killed) {
  const Stamp begin = begin_of(mission), end{std::numeric_limits<std::int64_t>::max()};
  CloudStore clouds(params.scans.clouds);
  std::vector<ScriptedRobot> robots(mission.robots.size());
  parallel_for(robots.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r) {
      ScriptedRobot& robot = robots[r];
      robot.name = mission.robots[r].id;
      robot.noise = mission.robots[r].odometry_noise;
      const auto run = [&](const ReplayWindow& window) {
        return replay(mission, RobotIndex(r), window, params.scans, params.keyframe, clouds);
      };
      const auto end_of = killed.find(robot.name);
      if (end_of == killed.end()) {
        robot.runs.push_back(scripted(begin, run({begin, end, true})));
        continue;
      }
      const Kill& kill = end_of->second;
      robot.runs.push_back(scripted(begin, run({begin, kill.at, false})));
      robot.runs.back().killed = kill.at;
      if (!kill.back) continue;
      robot.runs.push_back(scripted(*kill.back, run({*kill.back, end, true})));
    }
  });
  return robots;
}

}  // namespace radioslam
