// How a robot walks to another along the radio's direction, step by step, without a map. Source: Wang et al.,
// algorithm 2; steps p <- p + (w^2 / sigma^2) v, w the service discrepancy, v towards the strongest arrival,
// with lengths kept between two bounds. Where there is enough signal, more is asked for, so that the walk
// goes on until the robots see each other. All positions are in the robot's raw odometry.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "radioslam/rendezvous/rendezvous_params.hpp"
#include "radioslam/rendezvous/robot_interface.hpp"

namespace radioslam {

/// Obstacles that the robot has met lately, and ways round them.
class ObstacleMemory {
 public:
  void add(const SE2& raw_pose, const ObstacleAhead& obstacle);
  /// Whether something known is in the way of a step.
  bool blocks(const Eigen::Vector2d& from, double heading_rad, double length_m) const;
  /// The free heading next to the wanted one; on the side taken last while it is round something.
  double free_heading(const Eigen::Vector2d& from, double wanted_rad, double length_m);

 private:
  std::deque<Eigen::Vector2d> points_;
  int side_ = 0;  ///< +1: round to the left
  int steps_on_side_ = 0;
};

/// Where the other robot should be by what is known of both, in the body frame.
struct ExpectedDirection {
  double azimuth_rad = 0;
  double sigma_rad = 1;
  double least_distance_m = 0;  ///< the robot is hardly nearer than this
};

class AdaptiveWalk {
 public:
  explicit AdaptiveWalk(const RendezvousParams& params) : params_(params) {}

  /// A walk to another robot begins, which has a priority.
  void begin(double q_db, double alpha = 1);
  /// The next place, from the arrivals of the latest packet of the other robot; nothing where none is of use.
  std::optional<Eigen::Vector2d> next(const SE2& raw_pose, double esnr_db,
                                      const std::vector<ArrivalPath>& arrivals,
                                      const std::optional<ExpectedDirection>& expected, double max_step_m,
                                      ObstacleMemory& obstacles);

 private:
  double step_length(double esnr_db, const std::optional<ExpectedDirection>& expected, double max_step_m);
  double choose_heading(const SE2& raw_pose, const std::vector<ArrivalPath>& arrivals,
                        const std::optional<ExpectedDirection>& expected, double length_m,
                        const ObstacleMemory& obstacles) const;
  bool is_stuck(const Eigen::Vector2d& position, double esnr_db);

  RendezvousParams params_;
  double q_db_ = 0, alpha_ = 1;
  double best_esnr_db_ = 0;
  int steps_without_gain_ = 0, detours_ = 0, detour_steps_ = 0;
  double detour_heading_ = 0;
  std::deque<Eigen::Vector2d> trail_;
};

}  // namespace radioslam
