// What the robots of a recorded mission say on their way, each time that their programs run.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/live/scans_so_far.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/records/resumed_log.hpp"

namespace radioslam {

/// What a robot's front end says while its program runs once.
struct ScriptedRun {
  Stamp begin;
  std::optional<Stamp> killed;
  std::vector<std::pair<Stamp, std::string>> records;      ///< encoded, when they are said
  std::vector<std::pair<Stamp, StoredCloud>> clouds = {};  ///< of its keyframes
  ScannerFacts scanner = {};
  bool follows_scans = false;
  RecordedAtKeyframes recorded = {};
};
struct ScriptedRobot {
  std::string name;
  OdometryNoise noise = {};
  std::vector<ScriptedRun> runs;
};

/// A robot's program ends without notice, and is perhaps started again.
struct Kill {
  Stamp at;
  std::optional<Stamp> back = {};
};

/// The first odometry or scan of the mission.
Stamp begin_of(const Mission& mission);
/// The last one.
Stamp end_of(const Mission& mission);

/// In parallel. `killed`: by robot.
std::vector<ScriptedRobot> scripted_robots(const Mission& mission, const RunParams& params,
                                           const std::map<std::string, Kill>& killed = {});

}  // namespace radioslam
