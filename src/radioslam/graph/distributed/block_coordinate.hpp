// Riemannian block-coordinate descent: in a round every robot moves its own poses, its neighbours' at rest,
// and sends them.
// Sources: Tian, Khosoussi, Rosen, How 2021, Distributed certifiably correct pose-graph optimization (blocks,
// acceleration with restarts); Fan and Murphey 2021, Majorization minimization methods for distributed pose
// graph optimization (all robots at once: a factor between two robots counts double in a robot's own
// quadratic, which then bounds the cost from above whatever the neighbour does at the same time).
// Nesterov's momentum is each robot's own, dropped where it points uphill. The step solves the robot's own
// normal equations, so what is within a robot converges at once.
#pragma once

#include <optional>

#include "radioslam/graph/distributed/distributed_solver.hpp"
#include "radioslam/graph/distributed/frames.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {

struct BlockCoordinateParams {
  FrameVoteParams frames;
  double settled_decrease = 1e-10;   ///< predicted decrease of a step, relative to the robot's cost
  double absolute_decrease = 1e-12;  ///< smaller is small in any case
  /// Rounds without a word from a neighbour until its values are too old to be settled with. As long must a
  /// robot's own steps have been small.
  std::uint32_t max_age = 0;
};

template <class Pose>
class BlockCoordinateSolver : public DistributedSolver<Pose> {
 public:
  BlockCoordinateSolver(RobotGraph<Pose> robot, const BlockCoordinateParams& params);

  std::vector<Message<Pose>> round(const std::vector<Message<Pose>>& heard) override;
  bool settled() const override { return settled_; }
  std::vector<Pose> poses() const override { return poses_; }
  std::vector<Frame> frames() const override { return frames_.frames(robot_); }
  std::size_t refused() const override { return refused_; }

 private:
  void hear(const Message<Pose>& message);
  void prepare();
  /// Whether the step was small.
  bool step();
  bool all_heard() const;

  BlockCoordinateParams params_;
  RobotGraph<Pose> robot_;  ///< own poses are where the next step starts: with momentum
  FrameAgreement<Pose> frames_;
  std::vector<std::uint32_t> heard_until_;  ///< per neighbour: the round after the latest one heard
  std::vector<Pose> poses_;                 ///< without momentum: the estimate
  double momentum_ = 1;
  std::vector<std::uint32_t> usable_;
  PoseGraph<Pose> active_;  ///< the factors within the robot, then the usable ones; copies are fixed
  std::optional<NormalEquations<Pose>> equations_;
  std::uint32_t round_ = 0;
  std::uint32_t small_steps_ = 0;  ///< in a row
  bool settled_ = false;
  std::size_t refused_ = 0;
};

}  // namespace radioslam
