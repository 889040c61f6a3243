#include "radioslam/pipeline/scan_stage.hpp"

#include "radioslam/pipeline/lay_scans.hpp"
#include "radioslam/pipeline/scan_track.hpp"
#include "radioslam/pipeline/scans_as_odometry.hpp"

namespace radioslam {
namespace {

/// A robot that nothing tells to move, from its first scan on.
void stand_still(Robot& robot) {
  if (robot.odometry.empty()) robot.odometry = Trajectory<SE3>({{robot.lidar.stamps.front(), SE3()}});
}

/// What became of the robot's scans, before its odometry is replaced.
void note_scans(MeasuredScans& measured, const Robot& robot, const ScanTrack& track) {
  const auto note = [&](std::size_t count, const std::string& what) {
    if (count > 0) measured.notes.push_back("robot " + robot.id + ": " + std::to_string(count) + ' ' + what);
  };
  const auto outcome = [&](ScanOutcome o) { return track.outcomes.contains(o) ? track.outcomes.at(o) : 0; };
  measured.scans += robot.lidar.size();
  measured.registered += track.poses.size();
  measured.too_few += outcome(ScanOutcome::kTooFew);
  measured.unmatched += outcome(ScanOutcome::kUnmatched);
  note(outcome(ScanOutcome::kTooFew), "scans had hardly any points and were left out");
  note(outcome(ScanOutcome::kUnmatched), "scans did not fit the map and were left out");
  note(outcome(ScanOutcome::kNewMap),
       "times scans fitted nothing for long or were missing, and a new map was begun: how the robot moved "
       "there is not known");
  note(track.points.not_finite, "points were no numbers");
  note(track.points.off_time, "points' times were farther from their scan's than scan_points.most_time_s");
  note(track.points.far, "points were farther away than scan_points.most_range_m");
  note(rows_out_of_reach(robot.odometry, track),
       "rows of recorded odometry do not reach its scans and were left out");
}

void close_loops(MeasuredScans& measured, RobotIndex robot, const ScanTrack& track,
                 const ScanKeyframes& keyframes, const ScanParams& params, const Progress& progress) {
  const ScanLoops loops = close_scan_loops(keyframes, params.loops, params.lidar.map, params.search,
                                           params.lidar.registration, progress);
  for (const ScanLoop& loop : loops.loops)
    measured.closures.push_back({robot, track.poses[track.keyframes[loop.i]].stamp,
                                 track.poses[track.keyframes[loop.j]].stamp, loop});
}

}  // namespace

MeasuredScans measure_scans(Mission& mission, const ScanParams& params, const KeyframeParams& keyframes,
                            const Progress& progress) {
  MeasuredScans measured;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    Robot& robot = mission.robots[r];
    if (robot.lidar.empty()) continue;
    if (params.stage.odometry == "recorded" && !robot.odometry.empty()) continue;
    const ScannerTraits traits = scanner_traits(robot.lidar, params.lidar);
    ScanTrack track = lay_scans(robot, traits, params, keyframes, progress, measured.notes);
    note_scans(measured, robot, track);
    if (track.poses.empty()) {
      stand_still(robot);
      continue;
    }
    const ScanKeyframes scans = take_keyframes(track, traits);
    take_odometry(robot, track, params.stage);
    close_loops(measured, RobotIndex(r), track, scans, params, progress);
  }
  return measured;
}

}  // namespace radioslam
