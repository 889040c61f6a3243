// One robot of a team that meets when it must: it watches its error, calls others, answers their calls, walks
// to them along the radio's direction, exchanges what it measured, and estimates where all of them were.
// Sources: Wang et al., algorithms 1 and 2; robot_estimate.hpp for the estimate.
//
// It knows no simulator and no clock: everything comes in by events in the order of time, and every decision
// is an answer to a tick. Messages may be lost, late, repeated or out of order, and any robot may vanish:
// each says all its state again and again, and nobody waits for one that is not heard for longer than
// `lost_after_s`, or five decisions if they take longer. Same events, same answers.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/rendezvous/adaptive_walk.hpp"
#include "radioslam/rendezvous/anchored_exploration.hpp"
#include "radioslam/rendezvous/angle_evidence.hpp"
#include "radioslam/rendezvous/partner_choice.hpp"
#include "radioslam/rendezvous/published_error.hpp"
#include "radioslam/rendezvous/rendezvous_params.hpp"
#include "radioslam/rendezvous/robot_estimate.hpp"
#include "radioslam/rendezvous/robot_interface.hpp"
#include "radioslam/rendezvous/robot_message.hpp"

namespace radioslam {

class RendezvousRobot {
 public:
  RendezvousRobot(const std::string& id, const RobotStart& start, const RendezvousParams& params);

  void move(const OdometryStep& step);
  void see(const SeenRobot& seen);
  void hear(const HeardPacket& packet);
  void meet_obstacle(const ObstacleAhead& obstacle);
  TickAnswer tick(const DecisionTick& tick);
  /// Solves for what is known and not yet used.
  FinalTrajectory finish();

  RobotState state() const;
  double error() const;  ///< by the monitor
  const RobotEstimate& estimate() const { return team_; }
  double delta() const { return delta_; }
  /// Calls of this robot that a rendezvous has answered.
  int rendezvous_held() const { return rendezvous_held_; }
  /// Solutions of the estimate with new observations of or by this robot.
  int optimizations() const { return optimizations_; }

 private:
  /// What another robot was sent of a log.
  struct SentLog {
    std::uint32_t life = 0;
    std::uint64_t confirmed = 0, end = 0;  ///< records that it has said to have, and those sent
    int round = 0;                         ///< of the last progress
  };
  struct KeptPacket {
    double t_s = 0;
    std::vector<ArrivalPath> paths;
    bool said = false;  ///< in a record
  };
  /// Another robot as it is heard.
  struct Link {
    double heard_s = 0, esnr_db = 0;
    int heard_tick = 0;
    std::size_t node = 0;                                   ///< own pose of the latest packet
    std::map<std::size_t, std::deque<KeptPacket>> packets;  ///< per own pose, the latest ones
    std::shared_ptr<const RobotStatus> status;              ///< the latest
    int status_tick = 0;
    int walked_tick = 0;                  ///< when it last said that it had moved
    std::map<std::string, SentLog> sent;  ///< per robot whose log it is
  };
  /// A rendezvous that this robot has called for.
  struct Call {
    std::uint32_t number = 0;
    double error = 0;  ///< when it called
    double since_s = 0;
    int since_tick = 0;
    std::string partner;
    double partner_s = 0;
    int partner_tick = 0;
    bool confirmed = false;
    bool goes = false;  ///< the partner does not move, so that this robot walks
  };
  /// What another robot lacks, and how soon it gets it.
  struct Delivery {
    bool out_of_sight = true;
    double minus_esnr_db = 0;
    std::string robot;
    std::vector<std::string> logs;
  };
  struct Service {
    std::string caller;
    double since_s = 0;
    int since_tick = 0;
    bool seen_chosen = false;  ///< the caller has said that it takes this robot
  };

  bool is_gone(const Link& link) const;
  bool has_run_out(double since_s, int since_tick) const;
  const Link* present(const std::string& robot) const;
  int seen_since(const std::string& robot, double since_s) const;
  bool is_shunned(const std::string& robot) const;
  bool may_meet(const std::string& robot, const Link& link) const;
  bool is_placed(const Link& link) const;
  void shun(const std::string& robot);

  void say_angles(const std::string& robot, std::uint32_t node, Stamp stamp);
  void say_observations();
  void update_estimate(bool talk);
  double removable_error() const;
  bool wants_to_call() const;
  void follow_up_call();
  void choose_partner();
  void follow_up_service();
  void choose_caller();
  MeetingOption option_of(const std::string& robot, const Link& link) const;
  double distance_to(const Link& link) const;
  std::vector<AnchorNeighbour> anchor_neighbours() const;
  void take_turns();
  Movement walk_to(const std::string& robot);

  void write_status(TickAnswer& answer);
  bool is_heard_now(const std::string& robot) const;
  bool lacks(Link& link, const std::string& log, const LogVersion& version) const;
  std::vector<Delivery> deliveries(const std::map<std::string, LogVersion>& versions);
  void write_data(TickAnswer& answer);
  bool may_be_answered() const;
  Movement decide();
  std::optional<Movement> go_to_meeting_place();
  std::optional<ExpectedDirection> expected_direction(const Link& link) const;
  bool sees_now(const std::string& robot) const;

  std::string id_;
  RendezvousParams params_;
  RendezvousPolicy policy_;
  ErrorMonitor monitor_;
  double q_db_, delta_, max_step_m_;
  int kappa_;
  RobotEstimate team_;
  PublishedError published_;
  ObstacleMemory obstacles_;
  AdaptiveWalk walk_;
  std::map<std::string, Link> links_;
  std::vector<SeenRobot> unsaid_;                ///< seen from the latest pose since the last tick
  std::map<std::string, std::size_t> answered_;  ///< sightings of robots' logs to which the angles are said
  std::optional<Call> call_;
  std::optional<Service> service_;
  std::string offer_to_;
  std::map<std::string, double> shunned_;  ///< until when no rendezvous is tried with a robot
  std::uint32_t calls_ = 0;
  int rendezvous_held_ = 0, optimizations_ = 0;
  std::uint64_t statuses_ = 0;
  std::size_t calls_after_node_ = 0;  ///< pose before which there is no further call
  double now_s_ = 0, start_s_ = 0;
  int ticks_ = 0;                ///< decisions so far
  int rounds_ = 0;               ///< the same with talk ticks
  int refresh_tick_ = 0;         ///< from which news of others alone are used
  bool solved_in_talk_ = false;  ///< since the last decision
  AnchoredExploration anchored_;
  double return_s_ = 0;  ///< when the robot set out for its landmark
  int return_tick_ = 0;
  double walked_m_ = 0;
  std::optional<double> at_place_s_;
  int meetings_held_ = 0;
};

}  // namespace radioslam
