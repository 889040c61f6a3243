// From what an agent knows to what its live page shows: where the last solution and odometry since place
// every keyframe, closures and links, uncertainty, and thinned points of scans.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/cli/agent/agent_view.hpp"
#include "radioslam/pipeline/params.hpp"

namespace radioslam::cli {

class LiveView {
 public:
  static constexpr std::size_t kMostLines = 4000, kMostPoints = 150000;
  static constexpr double kCloudStride_m = 3;  ///< along a robot's way, from scan to scan

  /// Keeps a reference.
  explicit LiveView(const RunParams& params) : params_(params) {}

  /// The views of one agent, in their order.
  LiveTeam next(AgentView view);

 private:
  struct Solved {
    std::vector<Stamp> stamps;
    std::vector<SE3> poses;
    std::optional<double> sigma_m, sigma_team_m;
  };
  struct Line {
    ClosureResult closure;
    std::string robot_i, robot_j;
  };

  template <class Pose>
  void solve(const TeamSolution<Pose>& solution);
  void take(const AgentView& view);
  std::size_t number_of(const std::string& robot);
  LiveRobot place(const AgentView::Robot& robot, int dimension) const;
  void add_lines(LiveTeam& team) const;
  void add_clouds(LiveTeam& team);
  bool show_cloud(const AgentView::Cloud& cloud, const LiveTeam& team);

  const RunParams& params_;
  const void* solution_ = nullptr;  ///< that is taken
  std::shared_ptr<const void> held_;
  int dimension_ = 2;
  std::map<std::string, Solved> solved_;
  std::vector<Line> lines_;  ///< in the order of time
  std::map<std::pair<ClosureKind, ClosureStatus>, std::size_t> counts_;
  std::vector<std::string> names_;  ///< in the order in which they came up
  std::vector<LiveSigma> sigmas_;
  std::deque<AgentView::Cloud> waiting_;
  std::map<std::string, Eigen::Vector3d> last_cloud_;  ///< where the last one shown is, by robot
  std::vector<std::shared_ptr<const LiveCloud>> clouds_;
  std::size_t points_ = 0;
};

}  // namespace radioslam::cli
