// One robot of a team driven by lines from outside (robot_lines.hpp): it starts, takes what its robot
// measures and hears in the order of time, answers every tick, and ends with its trajectory. A line that is
// refused is answered by an error and changes nothing.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/rendezvous/robot_lines.hpp"
#include "radioslam/rendezvous/rendezvous_params.hpp"

namespace radioslam {

class RendezvousRobot;

/// Longest line that is read.
inline constexpr std::size_t kLongestLine_bytes = std::size_t{1} << 20U;

class RobotSession {
 public:
  /// Refuses (InputError) what cannot be the name of a robot.
  RobotSession(std::string id, const RendezvousParams& params);
  ~RobotSession();

  /// The lines that answer one line, without line ends. Blank lines are skipped, but counted.
  std::vector<std::string> line(std::string_view text);
  /// The lines that answer the end of the input: none unless the robot has started and not finished.
  std::vector<std::string> end();
  bool has_started() const { return robot_ != nullptr; }
  bool finished() const { return finished_; }

 private:
  using Lines = std::vector<std::string>;

  Lines answer(const RobotStart& start);
  Lines answer(const OdometryStep& step);
  Lines answer(const SeenRobot& seen);
  Lines answer(const HeardPacket& packet);
  Lines answer(const ObstacleAhead& obstacle);
  Lines answer(const DecisionTick& tick);
  Lines answer(const Finish& finish);
  RendezvousRobot& started();
  RendezvousRobot& at(double t_s);

  std::string id_;
  RendezvousParams params_;
  std::unique_ptr<RendezvousRobot> robot_;  ///< once it has started
  std::size_t lines_ = 0;
  double now_s_ = 0;
  bool finished_ = false;
};

}  // namespace radioslam
