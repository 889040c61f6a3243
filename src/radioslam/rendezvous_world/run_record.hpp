// What is noted of a simulated team, iteration by iteration.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/rendezvous_world/rendezvous_run.hpp"
#include "radioslam/rendezvous_world/simulated_team.hpp"

namespace radioslam {

class RunRecord {
 public:
  RunRecord(SimulatedTeam& team, double sensing_range_m);
  /// After an iteration.
  void add(SimulatedTeam& team, bool keep_moments);
  /// Ends the run: the robots give their trajectories.
  RendezvousRun conclude(SimulatedTeam& team);

 private:
  /// Where a robot is with its threshold.
  struct Watch {
    std::optional<double> crossed;  ///< error at which it passed the threshold
    int optimizations = 0;
  };
  void watch_threshold(std::size_t k, const SimulatedRobot& robot);
  void cover(const Eigen::Vector2d& place);

  RendezvousRun run_;
  std::vector<Watch> watches_;
  double sensing_range_m_;
  std::size_t cells_;
  std::vector<bool> covered_;
  double nees_sum_ = 0;
  std::size_t nees_count_ = 0;
};

}  // namespace radioslam
