// Distributed Gauss-Seidel in two stages: rotations from a linear relaxation, then poses.
// Source: Choudhary, Carlone, Nieto, Rogers, Christensen, Dellaert 2017, Distributed mapping with privacy and
// communication constraints; the relaxation is that of chordal.hpp, row by row.
//
// All stages solve a linear system of the whole team, A x = b, by blocks: in its turn (turns.hpp) a robot
// solves its own rows with what its neighbours said last, x_r += relaxation (A_rr^-1 (b_r - A_rs x_s) - x_r),
// and sends them what they see of it. Stages, which end when the whole team is at rest (stage_agreement.hpp):
//   0   frames: robots agree on one frame (frames.hpp) and learn who is in the team
//   1   the transposed rotations, as matrices; then each goes to the nearest rotation
//   2   the translations, given the rotations
//   3.. the poses: Gauss-Newton steps, linearised again in every stage, until one begins at rest.
// The first pose of the lowest robot stays, and so chooses the frame; a part of the team that shares no
// factors with it has its own.
// Gauss-Newton is not damped: from the relaxation it seldom needs to be, and nobody knows the team's cost.
// Messages must arrive in the round after they were sent; where they do not, the solver does not settle.
#pragma once

#include <algorithm>
#include <optional>

#include "radioslam/graph/distributed/distributed_solver.hpp"
#include "radioslam/graph/distributed/frames.hpp"
#include "radioslam/graph/distributed/stage_agreement.hpp"
#include "radioslam/graph/distributed/step_system.hpp"
#include "radioslam/graph/distributed/topology.hpp"
#include "radioslam/graph/distributed/turns.hpp"
#include "radioslam/graph/pose_network.hpp"

namespace radioslam {

struct TwoStageParams {
  FrameVoteParams frames;
  double relaxation = 1.8;        ///< of the moves, in (0, 2), in the rotations' and translations' stages
  double pose_relaxation = 1.93;  ///< in the poses', which are conditioned worse
  /// A move is small when it decreases the robot's cost by less than a share of it: in the rotations' and
  /// translations' stages,
  double start_decrease = 1e-3;
  /// in the first of the poses' stages, in the next one a tenth of that, ...
  double first_decrease = 1e-2;
  double settled_decrease = 1e-6;   ///< ... down to this, which is where they end,
  double absolute_decrease = 1e-9;  ///< or by less than this
};

template <class Pose>
class TwoStageSolver : public DistributedSolver<Pose> {
 public:
  TwoStageSolver(RobotGraph<Pose> robot, const TwoStageParams& params);

  std::vector<Message<Pose>> round(const std::vector<Message<Pose>>& heard) override;
  bool settled() const override { return stages_.finished(); }
  std::vector<Pose> poses() const override;
  std::vector<Frame> frames() const override { return frames_.frames(robot_); }
  std::size_t refused() const override { return refused_; }

 private:
  using Steps = typename StepSystem<Pose>::Steps;
  enum Stage : std::uint32_t { kFrames, kRotations, kTranslations, kPoses };
  Stage stage() const { return static_cast<Stage>(std::min<std::uint32_t>(stages_.stage(), kPoses)); }

  bool hear(const Message<Pose>& message);
  bool take_values(const Message<Pose>& message);
  template <class Value>
  bool take_items(RobotNumber from, const std::vector<Value>& items, std::vector<Value>& values);

  void go_on(StageEnd end);
  void keep_result();
  void build_active();
  bool prepare();

  Activity act();
  Activity agree_on_frames();
  Activity move_rotations();
  Activity move_translations();
  Activity move_poses();
  bool small(double decrease, double cost, double share) const;
  std::uint32_t rounds_at_rest() const { return turns_->diameter() + turns_->colours() + 1; }

  void tell_values(const NeighbourRobot& neighbour, Message<Pose>& message) const;
  std::vector<Message<Pose>> messages();

  TwoStageParams params_;
  RobotGraph<Pose> robot_;
  FrameAgreement<Pose> frames_;
  TopologyGossip gossip_;
  StageAgreement stages_;
  std::optional<TurnOrder> turns_;  ///< once the team is known

  PoseGraph<Pose> active_;  ///< the factors that count; copies and what chooses the frame are fixed
  std::optional<PoseNetworkSolver<Pose>> network_;
  std::optional<StepSystem<Pose>> system_;
  PoseMatrices<Pose> rotations_;  ///< per pose: relaxed, transposed
  Steps steps_;                   ///< per pose, from where the stage was linearised

  bool begins_ = false;               ///< the stage, and neighbours have not heard from where
  bool prepared_ = false;             ///< all neighbours' values of the stage are there
  bool failed_ = false;               ///< the robot's own system is singular
  bool tell_ = true;                  ///< neighbours what they see
  std::vector<RobotNumber> unaware_;  ///< neighbours that were heard and have not finished
  std::uint32_t round_ = 0;
  std::size_t refused_ = 0;
};

}  // namespace radioslam
