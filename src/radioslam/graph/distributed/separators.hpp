// Optimisation by elimination on a tree over the robots: Gauss-Newton steps of the whole team that are as
// good as central ones, in as many rounds as the tree is deep, up and down.
//
// Every robot eliminates its poses that no other robot has factors with. What that leaves on the others goes
// up the tree, where every robot adds its children's to its own and eliminates what nobody above shares: a
// junction tree whose clusters are the robots. The root solves, and the steps come down the same way. A
// factor between two robots is held by one of them, the one whose neighbour has fewer poses in them.
//
// The information that goes up is rounded (information_code.hpp), and sent again only where the steps were
// large: sweeps in between carry gradients alone. Gradients are exact, so the sweeps end at the optimum.
// Sources: Dechter 2003 (bucket and junction trees); Petcu and Faltings 2005 (the same over agents);
// Cunningham et al. 2010, DDF-SAM (separators between robots).
#pragma once

#include <map>
#include <optional>

#include "radioslam/graph/distributed/cluster.hpp"
#include "radioslam/graph/distributed/distributed_solver.hpp"
#include "radioslam/graph/distributed/frames.hpp"
#include "radioslam/graph/distributed/held_factors.hpp"
#include "radioslam/graph/distributed/outliers.hpp"
#include "radioslam/graph/distributed/topology.hpp"

namespace radioslam {

struct SeparatorsParams {
  FrameVoteParams frames;
  OutlierParams outliers;
  double relinearise_above = 0.01;  ///< predicted decrease, relative to the cost
  double settled_decrease = 1e-6;   ///< the same, where the sweeps end
  double absolute_decrease = 1e-9;  ///< smaller ends them in any case
  double first_damping = 1e-4, damping_factor = 10;
  std::uint32_t repeat_after = 0;  ///< rounds without an answer until a message is repeated; 0: never
  std::uint32_t lost_after = 100;  ///< with repeats: rounds without a word until a robot counts as gone
};

template <class Pose>
class SeparatorsSolver : public DistributedSolver<Pose> {
 public:
  SeparatorsSolver(RobotGraph<Pose> robot, const SeparatorsParams& params);

  std::vector<Message<Pose>> round(const std::vector<Message<Pose>>& heard) override;
  bool settled() const override { return finished_ && !failed_; }
  bool hears_neighbours() const override;
  std::vector<Pose> poses() const override { return published_; }
  std::vector<Frame> frames() const override { return frames_.frames(robot_); }
  std::size_t refused() const override { return refused_; }
  std::vector<std::optional<double>> weights() const override;

 private:
  /// One pass up and down the tree.
  struct Sweep {
    std::uint32_t number = 0;
    bool relinearise = true;  ///< information goes up, not gradients alone
    double damping = 0;
    double mu = 0;  ///< of graduated optimization; 0: every factor is taken as it is
    bool linearised = false;
    bool waiting = false;  ///< for the steps from above
    double cost = 0;       ///< of the factors held here
    std::map<RobotNumber, Elimination> children;
  };

  bool hear(const Message<Pose>& message);
  bool hear_child(RobotNumber from, const Elimination& up);
  bool hear_parent(RobotNumber from, const Solution& down);
  void keep_in_touch();
  bool repeats() const { return params_.repeat_after > 0; }
  bool awaits(const SeenPoses<Pose>& seen) const;
  void tell_poses();
  void meet(std::map<RobotNumber, RobotLinks> team);
  bool in_team_frame(std::size_t pose) const;
  bool in_one_frame() const;
  bool is_linked(RobotNumber neighbour) const { return team_.at(robot_.robot).links_to(neighbour); }
  void prepare_sweeps();
  bool holds(const NeighbourRobot& neighbour) const;
  std::vector<KeptPose> kept_poses(const std::vector<bool>& copy_held) const;

  void advance();
  void linearise();
  bool can_share(RobotNumber child, const std::vector<SharedPose>& shared) const;
  bool eliminate();
  Elimination sums() const;
  void go_up();
  Solution decide(const Elimination& team);
  void go_down(Solution solution);
  void publish();
  Message<Pose>& message_to(RobotNumber robot);
  std::vector<Message<Pose>> messages();

  SeparatorsParams params_;
  RobotGraph<Pose> robot_;
  FrameAgreement<Pose> frames_;
  TopologyGossip gossip_;
  std::map<RobotNumber, RobotLinks> team_;  ///< that the tree is of; empty: not known yet
  std::optional<TeamTree> tree_;
  std::vector<RobotNumber> children_;
  std::vector<std::size_t> held_list_;     ///< places in robot_.graph.relative_poses
  std::vector<bool> may_be_outlier_;       ///< per relative pose
  std::vector<double> weights_;            ///< per relative pose; of those held here
  std::optional<HeldFactors<Pose>> held_;  ///< once the sweeps can begin
  std::optional<Cluster> cluster_;
  std::map<RobotNumber, Eigen::Index> child_scalars_;  ///< of the steps that each child shares
  Sweep sweep_;
  std::vector<Pose> before_;                   ///< where the last sweep started
  double last_cost_ = 0, last_predicted_ = 0;  ///< of the team, at the root
  bool finished_ = false;
  bool failed_ = false;              ///< the sweeps cannot go on
  std::vector<Pose> published_;      ///< own poses after the last sweep that all robots have ended
  std::uint32_t rounds_to_end_ = 0;  ///< until the robots furthest from the root have ended theirs

  std::map<RobotNumber, Elimination> early_;   ///< of children, for a tree or sweep still to come
  std::map<RobotNumber, Solution> last_down_;  ///< as sent to the children
  std::optional<Elimination> last_up_;
  std::map<RobotNumber, std::uint32_t> last_heard_, last_sent_;  ///< rounds, per neighbour
  std::map<RobotNumber, std::uint32_t> heard_until_;  ///< the round after the latest poses heard, as sent
  std::map<RobotNumber, Message<Pose>> outgoing_;
  std::map<RobotNumber, bool> tell_poses_;  ///< per neighbour
  std::uint32_t round_ = 0;
  std::size_t refused_ = 0;
};

}  // namespace radioslam
