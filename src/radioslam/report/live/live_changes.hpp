// What changes on the live page from one time to the next, as JSON; and the whole, for a page that has
// nothing. Applied in their order, the changes give the whole.
//
//   {"whole": true where it replaces all, "t", "rate",
//    "robots": [{"robot", "id", "frame", "count", "from", "t", "x", "y", "z", "heading"}], of those that
//    changed, "lines": {"groups": [{"kind", "status", "count"}], "from", "group", "robot_i", "keyframe_i",
//    "robot_j",
//              "keyframe_j"}, if they changed,
//    "clouds": [{"robot", "t", "x", "y", "z"}],
//    "team": [{"id", "keyframes", "sigma_m", "sigma_team_m", "here", "said"}], "peers": [...], "sent": [...],
//    "known": [{"t", "share", "error_m"}], "sigmas": [{"t", "sigma_m", "sigma_team_m"}], "events": [{"t",
//    "what"}]}
//
// Poses are those from index "from" on, up to the last that changed, in whole steps (kStep_m, kStep_s,
// kStep_rad), each as the difference to the one before it; "count": how many the robot has in all. A pose
// moves on the page once it has moved by more than its rounding. Clouds: in steps of kStep_m. "known",
// "sigmas", "events" and "clouds" are those that were added.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/report/live/live_team.hpp"
#include "radioslam/report/rounding.hpp"

namespace radioslam {

class LiveChanges {
 public:
  static constexpr double kStep_m = 0.02, kStep_s = 0.01, kStep_rad = 0.01;
  static constexpr std::size_t kMostPoses =
      40000;  ///< of more, every second one is shown, or every fourth ...

  PageData next(LiveTeam team);
  PageData whole() const;

 private:
  /// A robot's poses in steps: t, x, y, z, heading.
  using Columns = std::vector<std::vector<std::int32_t>>;
  struct Shown {
    LiveTeam team;  ///< without its poses
    std::vector<Columns> poses;
    std::size_t stride = 1;
  };

  static Shown shown(LiveTeam team, const Shown& before);
  static Columns in_steps(const LiveTeam& team, const LiveRobot& robot, std::size_t stride,
                          const Columns* before);
  static PageData describe(const Shown& before, const Shown& now);
  static PageData robots_data(const Shown& before, const Shown& now);
  static PageData lines_data(const Shown& before, const Shown& now);

  Shown shown_;
};

}  // namespace radioslam
