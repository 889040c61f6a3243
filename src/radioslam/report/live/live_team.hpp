// What the live page shows of a team, as one of its agents knows it at one time.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct LivePose {
  Stamp stamp;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< in the robot's frame of the team
  double heading_rad = 0;
};

struct LiveRobot {
  std::string id;
  std::string frame;                        ///< its first robot
  std::vector<LivePose> poses = {};         ///< of its keyframes
  std::optional<double> sigma_m = {};       ///< of the last one that the estimate has, as in RobotResult
  std::optional<double> sigma_team_m = {};  ///< the same in the gauge of the team
};

/// A closure or link between two keyframes.
struct LiveLine {
  ClosureKind kind = ClosureKind::kRange;
  ClosureStatus status = ClosureStatus::kAccepted;
  std::size_t robot_i = 0, keyframe_i = 0, robot_j = 0, keyframe_j = 0;
  bool operator==(const LiveLine&) const = default;
};

/// Points of a keyframe's scan about its position, turned by its heading alone.
struct LiveCloud {
  std::size_t robot = 0;
  Stamp keyframe;
  std::vector<Eigen::Vector3f> points;
};

struct LivePeer {
  std::string id;
  std::optional<double> silent_s;  ///< since it was heard; nothing: never
  bool is_heard = false, solves = true;
  std::uint64_t knows_of_own = 0;              ///< records of this agent's robot that it has
  std::map<std::string, std::size_t> refused;  ///< of what it sent, by reason
};

/// How far somebody's log is known.
struct LiveLog {
  std::uint64_t here = 0, said = 0;  ///< records that this agent has, and that somebody is known to have
};

struct LiveTraffic {
  std::string peer, kind;
  bool is_sent = true;
  std::size_t messages = 0, bytes = 0, lost = 0;
};

/// How well the team was known when the agent had an estimate.
struct LiveKnown {
  Stamp at;
  double share = 0;  ///< of all records
  std::optional<double> error_m{};
};

struct LiveSigma {
  Stamp at;
  double sigma_m = 0, sigma_team_m = 0;  ///< of the agent's own robot
};

/// Robots, clouds, `known`, `sigmas` and events are added at the end, and stay.
struct LiveTeam {
  std::string self;  ///< robot of the agent
  int dimension = 2;
  Stamp start, now;
  double rate = 1;  ///< at which a recording is replayed
  std::vector<LiveRobot> robots;
  std::vector<LiveLine> lines;  ///< those that are drawn
  std::map<std::pair<ClosureKind, ClosureStatus>, std::size_t> closures;
  std::vector<std::shared_ptr<const LiveCloud>> clouds;
  std::vector<LivePeer> peers;
  std::map<std::string, LiveLog> logs;
  std::vector<LiveTraffic> traffic;
  std::vector<LiveKnown> known;
  std::vector<LiveSigma> sigmas;
  std::vector<std::pair<Stamp, std::string>> events;
};

}  // namespace radioslam
