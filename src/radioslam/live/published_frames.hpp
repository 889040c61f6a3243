// Where the robots' odometry lies in the frames of the team, as it is published.
//
// A frame is named by its first robot. Robots whose alignment is ambiguous are in frames of their own. What
// moves by more than a metre or six degrees is an event, and so is a robot that comes into another frame.
//
// Places that look alike deceive closures, and radio distinguishes them: in a team that has links, a robot
// that closures alone put into a frame stays in its own until links agree. Without any it is there, and the
// event says so.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/joint/team_estimate.hpp"
#include "radioslam/live/scans_so_far.hpp"

namespace radioslam {

struct TeamEvent {
  Stamp at;
  std::string what;
  bool is_join = false;  ///< a robot comes into another frame
};

/// Where a robot's odometry starts in its frame.
struct PublishedFrame {
  std::string frame;  ///< its first robot
  SE3 T_frame_start;
  std::string by_closures = {};  ///< the frame into which closures alone put the robot; empty: they do not
};

/// A pose as an estimate in this dimension has it: in the plane, at height 0.
template <class Pose>
SE3 in_dimension(const SE3& pose) {
  return as_se3(pose_as<Pose>(pose), 0);
}

class PublishedFrames {
 public:
  /// Of a robot; one that was in no estimate is in a frame of its own.
  PublishedFrame of(const std::string& robot) const;

  /// Moves the frames to the estimate. `keyframes`: of its robots, as their logs say them.
  template <class Pose>
  std::vector<TeamEvent> move_to(const TeamEstimate<Pose>& team, Stamp now,
                                 const std::map<std::string, LoggedKeyframes>& keyframes);

 private:
  void move(const std::string& robot, PublishedFrame to, Stamp now, const SE3& odometry,
            std::vector<TeamEvent>& events);

  std::map<std::string, PublishedFrame> frames_;
};

/// The robots of the frame with the most, as the estimate places them.
template <class Pose>
std::vector<EstimatedTrajectory> largest_frame(const TeamEstimate<Pose>& team, const PublishedFrames& frames);

}  // namespace radioslam
