// A robot's log after its program was started again: what the new front end says, as more of the same log.
//
// Keyframes and access points are numbered on. Where the odometry is of another source that was not stopped,
// the motion in between is what it says; else it is not known, and one keyframe is missing (mission_of_logs).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/records/team_log.hpp"

namespace radioslam {

class ResumedLog {
 public:
  /// `before`: the log so far. `odometry_goes_on`: in the frame in which it was said.
  ResumedLog(const KnownLog& before, bool odometry_goes_on);

  /// A record of the new front end as the log has it, encoded; nothing for what the log says already.
  std::optional<std::string> continued(const std::string& record);

 private:
  bool odometry_goes_on_;
  std::uint32_t keyframes_ = 0, access_points_ = 0;  ///< numbers that are taken
  std::optional<SE3> T_start_last_;                  ///< by the odometry as it was said
};

}  // namespace radioslam
