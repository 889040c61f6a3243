// The radio links of a team with the dead reckoning of its robots, small enough to be copied and changed:
// what a mission's measurements would look like if a fault of it were corrected.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {

/// Dead reckoning of one robot, thinned out to about half a metre or a second, in the robot's own frame.
class Track {
 public:
  Track() = default;
  explicit Track(const Robot& robot);

  struct Row {
    double t_s;
    Eigen::Vector3d position_m;
    Eigen::Quaterniond rotation;  ///< R_start_body
    double path_m;                ///< length of the path so far
  };

  bool empty() const { return rows_.empty(); }
  /// By linear interpolation; nothing outside the time covered.
  std::optional<Row> at(double t_s) const;
  double path_m() const { return rows_.empty() ? 0 : rows_.back().path_m; }
  const std::vector<Row>& rows() const { return rows_; }
  /// Motion between two times covered, with the stated noise of the odometry.
  template <class Pose>
  OdometryEdge<Pose> motion(double begin_s, double end_s) const;

  void mirror();  ///< y and yaw change sign
  void scale(double factor);
  void shift(double seconds) { shift_s_ += seconds; }

 private:
  std::vector<Row> rows_;
  OdometryNoise noise_;
  double shift_s_ = 0;  ///< added to the recorded times
};

/// End of a link: a robot's antenna, or a point of the common frame (an anchor or a position fix).
struct TrackEnd {
  std::size_t node = 0;  ///< robot, or TeamLinks::world()
  Eigen::Vector3d point_m =
      Eigen::Vector3d::Zero();  ///< in the body frame, or in the common one about its origin
};

/// A range, an angle or a position fix (a range of zero).
struct TrackLink {
  enum class Kind { kRange, kAngle, kFix } kind = Kind::kRange;
  double t_s = 0;
  TrackEnd a, b;  ///< of an angle: receiver and transmitter
  double range_m = std::numeric_limits<double>::quiet_NaN();
  double sigma = 1;            ///< metres or radians
  std::vector<AoaPath> paths;  ///< of an angle
  double log_density = 0;      ///< log of how many times denser corrected ranges lie than the recorded ones
};

struct TeamLinks {
  std::vector<Track> tracks;     ///< one per robot
  std::vector<TrackLink> links;  ///< in time order within each kind
  bool is_planar = true;
  Eigen::Vector3d world_origin_m = Eigen::Vector3d::Zero();  ///< of the points' frame, in the common frame

  std::size_t world() const { return tracks.size(); }
};

/// All links of the mission whose ends have odometry or a known position.
TeamLinks team_links(const Mission& mission);

/// Links between two nodes, `i` < `j`, that belong to a stretch short enough for dead reckoning to hold.
struct LinkWindow {
  std::size_t i = 0, j = 0;
  std::vector<std::size_t> links;  ///< indices into TeamLinks::links
  double path_m = 0;               ///< of both robots within the window
};

/// Windows spread over the mission, at most `per_pair` (two or more) of every pair of nodes: short ones, in
/// which dead reckoning is nearly exact, and a long one, in which a constant error of ranges shows.
std::vector<LinkWindow> link_windows(const TeamLinks& team, std::size_t per_pair);

/// Drops the links that are in no window, so that copies of the team stay small.
void keep_links_of(std::vector<LinkWindow>& windows, TeamLinks& team);

}  // namespace radioslam
