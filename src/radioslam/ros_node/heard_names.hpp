// The team as a robot knows it: what its mission states, and whom it hears of. A name that is no anchor's is
// a robot's.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/mission/team_names.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/ros_node/notes_once.hpp"

namespace radioslam {

class HeardNames {
 public:
  static constexpr std::size_t kMostRobots = 64, kMostAccessPoints = 20000;

  /// `antennas`: by robot, may be shorter.
  HeardNames(Mission mission, RobotIndex self, std::vector<Antennas> antennas);

  /// Without recordings.
  const Mission& mission() const { return mission_; }
  Robot& robot() { return mission_.robots[self_.index()]; }
  RobotIndex self() const { return self_; }

  /// This robot's antenna, at `lever_arm_m` where that is known otherwise.
  LinkEnd own_end(const std::string& antenna, const std::optional<Eigen::Vector3d>& lever_arm_m) const;
  /// The other end of a link; nothing for this robot itself, for what cannot be a name, and beyond
  /// kMostRobots.
  std::optional<LinkEnd> other_end(const std::string& name, const std::string& antenna, NotesOnce& notes);
  /// Of an address in any spelling; nothing if it is none, and beyond kMostAccessPoints.
  std::optional<AccessPointIndex> access_point(const std::string& bssid);

 private:
  Eigen::Vector3d lever_arm(std::size_t robot, const std::string& antenna) const;

  Mission mission_;
  RobotIndex self_;
  std::vector<Antennas> antennas_;
  std::map<std::string, AccessPointIndex> access_points_;
};

}  // namespace radioslam
