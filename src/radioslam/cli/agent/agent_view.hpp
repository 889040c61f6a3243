// What a robot's agent knows at one time, for the threads that show it: values that nobody changes any more.
// Cheap to make, as solutions are shared and of keyframes only those since the last one are copied.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "radioslam/report/live/live_team.hpp"
#include "radioslam/team/virtual_team.hpp"

namespace radioslam::cli {

struct AgentView {
  struct Robot {
    std::string id;
    PublishedFrame frame;
    std::vector<StampedPose<SE3>> said;  ///< T_start_body, from the solution's last keyframe on
  };
  struct Cloud {
    std::string robot;
    Stamp keyframe;
    StoredCloud points;
  };

  LiveTeam team;         ///< but for robots, lines, clouds and sigmas
  AnySolution solution;  ///< may be null
  std::vector<Robot> robots;
  std::vector<Cloud> clouds;  ///< that were not in a view before
};

/// Makes the views of one agent.
class AgentViewer {
 public:
  /// `run`: of the agent alone, so far; `received`: by the others.
  AgentView view(const Agent& agent, const TeamRun& run, const TeamTraffic& sent, const TeamTraffic& received,
                 Stamp now);

 private:
  void add_clouds(const std::string& robot, const ScansSoFar& scans, AgentView& view);

  std::map<std::string, std::set<Stamp>> seen_;  ///< keyframes whose clouds were in a view, by robot
};

}  // namespace radioslam::cli
