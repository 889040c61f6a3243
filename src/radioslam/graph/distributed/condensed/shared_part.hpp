// What a robot of a team that is seldom connected shares of its part of the pose graph: the poses that
// somebody has seen or was seen from, its odometry condensed to steps between them, and what it saw.
//
// A part holds what its robot measured and nothing that it heard. Parts can therefore be passed on, come
// twice or out of order, and be put together by whoever has them, and no measurement is ever counted twice.
// Sources: Cunningham et al. 2010, DDF-SAM (condensed maps of neighbours); Lazaro et al. 2013 (condensed
// measurements).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {

/// A pose of the robot that others may refer to.
struct SharedNode {
  std::uint32_t number = 0;          ///< along the robot's trajectory; 0: its start
  double t_s = 0, until_s = 0;       ///< it was the robot's latest pose from t_s to until_s
  UncertainPose<SE2> from_before{};  ///< T_before_node from the shared node before it; of the start: identity
};

/// What angles of arrival at one end say of a relative pose between two robots.
struct AngleEvidence {
  double log_odds = 0;  ///< against it, of a direction drawn evenly
  double scale = 1;     ///< of its information by Wang et al., eq. 7
};

/// Robot `robot` seen from this one, and from which of its poses.
struct SharedObservation {
  std::uint32_t node = 0;  ///< number of the own pose
  std::string robot;
  double t_s = 0;
  SE2 T_i_j;
  double sigma_m = 1, sigma_rad = 1;  ///< per axis
  AngleEvidence evidence{};           ///< by the angles heard at this robot
};

/// What the angles heard at this robot say of how another saw it.
struct SharedEvidence {
  std::string by;  ///< the robot that saw this one
  double t_s = 0;
  AngleEvidence angles{};
};

struct SharedPart {
  std::string robot;
  std::uint64_t version = 0;      ///< higher ones replace lower ones
  std::optional<SE2> start;       ///< of its start in the common frame, where that is known
  std::vector<SharedNode> nodes;  ///< by ascending number; the start first
  std::vector<SharedObservation> observations;
  std::vector<SharedEvidence> evidence;

  /// The pose that was the robot's latest at a time; null if it is not among the nodes.
  const SharedNode* node_at(double t_s) const;
  /// Place in `nodes`; their number if there is none.
  std::size_t place_of(std::uint32_t number) const;
};

/// As many as a message holds, and more than a part may have of them is refused.
inline constexpr std::size_t kMaxSharedNodes = 100, kMaxSharedEntries = 150;

/// Where a robot that starts at a time begins to count what it says: above all of a life before.
std::uint64_t first_number(double t_s);

/// Whether a part that somebody sent can be put into a graph: not too long, finite numbers, positive sigmas,
/// nodes in order, observations of its own nodes.
bool is_well_formed(const SharedPart& part);

}  // namespace radioslam
