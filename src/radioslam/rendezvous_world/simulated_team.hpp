// The robots of a simulated team on their floor: how they move, what they see and hear, and what they say.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/rendezvous/rendezvous_robot.hpp"
#include "radioslam/rendezvous_world/rendezvous_run.hpp"

namespace radioslam {

/// A robot that is heard where both are now.
struct HeardRobot {
  std::size_t from = 0;
  PacketReception reception;
};

struct SimulatedRobot {
  std::string name;
  std::unique_ptr<RendezvousRobot> agent;
  SE2 truth, raw;               ///< in the common frame, and by odometry from its start
  std::vector<SE2> trajectory;  ///< true poses, per pose of its estimate
  Eigen::Vector2d waypoint = Eigen::Vector2d::Zero();
  double walked_m = 0;
  Movement movement;
  RobotState state;
  std::vector<OutgoingMessage> outbox;
  std::vector<HeardRobot> heard;
  bool got_anything = false, got_data = false;  ///< messages in the last exchange
  bool talks = false;                           ///< has something new to say
  std::set<std::size_t> seen, seen_before;  ///< robots within sensing range, now and in the last iteration
  Rng motion{0}, sensing{0};
};

class SimulatedTeam {
 public:
  SimulatedTeam(const RendezvousRunParams& params, const RendezvousRunOptions& options);

  /// One iteration: all robots move, see, hear and decide, and say what they have to say.
  void step();
  bool all_have_walked() const;
  const Arena& arena() const { return arena_; }
  std::vector<SimulatedRobot>& robots() { return robots_; }
  std::size_t index_of(const std::string& name) const { return names_.at(name); }

 private:
  double left_m(const SimulatedRobot& robot) const;
  Eigen::Vector2d wanted(SimulatedRobot& robot);
  void move(SimulatedRobot& robot);
  SE2 measured(const SE2& T_i_j, Rng& rng, bool& wrong) const;
  void sense(std::size_t k);
  void listen(std::size_t k);
  bool is_lost(std::size_t from, std::size_t to) const;
  void deliver(std::size_t k, bool talk);
  void exchange(bool talk);
  bool anybody_sends_data() const;

  RendezvousRunParams params_;
  RendezvousRunOptions options_;
  Rng rng_;
  Arena arena_;
  PacketRadio radio_;
  std::vector<SimulatedRobot> robots_;
  std::map<std::string, std::size_t> names_;
  std::uint64_t iteration_ = 0, rounds_ = 0;
  double time_s_ = 0;
};

}  // namespace radioslam
