// A recorded team as its estimate grows: what each robot's front end says, in the order of time, and the
// team's estimate made again as more becomes known (stream_effort.hpp).
//
// Between two estimates a robot's pose follows its odometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/front_end/replay.hpp"
#include "radioslam/live/published_frames.hpp"
#include "radioslam/live/stream_effort.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/params.hpp"

namespace radioslam {

/// A keyframe where the team's estimate placed it when it was said.
struct OnlineKeyframe {
  std::size_t robot = 0;  ///< of the mission
  std::uint32_t number = 0;
  Stamp stamp;
  SE3 T_frame_body;
  std::size_t frame = 0;                  ///< the first robot in it
  std::optional<std::size_t> estimate{};  ///< the last one before; nothing: by odometry alone
};

struct OnlineEstimate {
  Stamp at;
  Effort effort = Effort::kExtend;
  double seconds = 0;               ///< that it took
  std::size_t keyframes = 0;        ///< known to it
  double weight = 1;                ///< of its alignment among others
  std::vector<std::size_t> frame;   ///< of every robot of the mission: the first robot in it
  std::optional<double> error_m{};  ///< of the frame with the most robots; where the truth is known
};

struct StreamedTeam {
  std::vector<OnlineKeyframe> keyframes;  ///< in the order in which they were said
  std::vector<OnlineEstimate> estimates;
  std::vector<TeamEvent> events;
};

/// Position error of trajectories in one frame against the truth, RMSE in metres; nothing without.
using ErrorOf = std::function<std::optional<double>(const std::vector<EstimatedTrajectory>&)>;

/// `robots`: in the order of the mission. All but the seconds is the same for any number of threads.
StreamedTeam stream_team(const Mission& mission, const std::vector<ReplayedRobot>& robots,
                         const RunParams& params, const StreamParams& stream, const ErrorOf& error_of = {},
                         const Progress& progress = {});

}  // namespace radioslam
