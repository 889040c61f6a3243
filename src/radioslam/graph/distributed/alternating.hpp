// Alternation of own trajectories and frames between robots.
// Source: Huang, Shan, Chen, Englot 2022, DiSCo-SLAM (two-stage global and local optimisation).
//
// In even rounds a robot moves its own poses, in odd ones each part of its trajectory as a rigid body, by its
// factors with others alone; others' poses rest. All robots move at once: the information of a factor between
// two robots counts double in the quadratic that a robot minimises, its gradient once, which bounds the
// linearised cost from above whatever the neighbour does (Fan and Murphey 2021). A part whose frame the
// others have adopted does not move as a body. As block coordinate descent without momentum, it needs rounds
// in proportion to the condition of the team's graph of robots.
#pragma once

#include <optional>

#include "radioslam/graph/distributed/distributed_solver.hpp"
#include "radioslam/graph/distributed/frames.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {

struct AlternatingParams {
  FrameVoteParams frames;
  double settled_decrease = 1e-8;   ///< predicted decrease of either move, relative to the robot's cost
  double absolute_decrease = 1e-9;  ///< smaller is small in any case
};

template <class Pose>
class AlternatingSolver : public DistributedSolver<Pose> {
 public:
  AlternatingSolver(RobotGraph<Pose> robot, const AlternatingParams& params);

  std::vector<Message<Pose>> round(const std::vector<Message<Pose>>& heard) override;
  /// Both of the last moves were small, with all neighbours heard.
  bool settled() const override;
  std::vector<Pose> poses() const override { return robot_.trajectory(); }
  std::vector<Frame> frames() const override { return frames_.frames(robot_); }
  std::size_t refused() const override { return refused_; }

 private:
  void prepare();
  void move_poses();
  void move_parts();
  double move_part(std::size_t part);
  bool small(double decrease) const;

  AlternatingParams params_;
  RobotGraph<Pose> robot_;
  FrameAgreement<Pose> frames_;
  std::vector<std::uint32_t> usable_;
  PoseGraph<Pose> active_;  ///< the factors within the robot, then the usable ones; copies are fixed
  std::optional<NormalEquations<Pose>> equations_;
  double cost_ = 0;  ///< of the active factors
  bool poses_rest_ = false, parts_rest_ = false;
  std::uint32_t round_ = 0;
  std::size_t refused_ = 0;
};

}  // namespace radioslam
