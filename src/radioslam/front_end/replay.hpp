// A recorded mission as its robots live through it: every sample in time order through a front end a robot.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/front_end/front_end.hpp"
#include "radioslam/lidar/clouds/cloud_store.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/records/team_log.hpp"

namespace radioslam {

/// A pose when it was added, and the time that its sample took.
struct ReplayedPose {
  OnlinePose pose;
  std::optional<std::uint32_t> keyframe;  ///< its number, if it is one
  double delay_s = 0;                     ///< of the recording, from the pose's stamp until it was known
  double latency_ms = 0;                  ///< of the machine, from the sample that completed it
};

struct ReplayedRobot {
  std::vector<ReplayedPose> poses;
  std::vector<FrontEndEvent> events;
  RobotLog log;              ///< with amendments
  std::vector<Stamp> known;  ///< when each of its records was said
  std::optional<TrackedScans> tracked;
  bool follows_scans = false;    ///< its poses are those of scans
  RecordedAtKeyframes recorded;  ///< of such a robot
  std::size_t left_out = 0;
};

/// When a robot's program ran.
struct ReplayWindow {
  Stamp begin, end;          ///< samples outside are not taken
  bool is_finished = false;  ///< it ended of itself: with all that hindsight makes of it
};

/// One robot.
ReplayedRobot replay(const Mission& mission, RobotIndex self, const ReplayWindow& window,
                     const ScanParams& scans, const KeyframeParams& keyframes, CloudStore& clouds,
                     const Progress& progress = {});

/// The robots of the mission, in parallel. Poses, events and logs do not depend on the number of threads.
std::vector<ReplayedRobot> replay(const Mission& mission, const ScanParams& scans,
                                  const KeyframeParams& keyframes, const Progress& progress = {});

}  // namespace radioslam
