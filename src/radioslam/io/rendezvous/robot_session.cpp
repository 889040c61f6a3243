#include "radioslam/io/rendezvous/robot_session.hpp"

#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/rendezvous/json_values.hpp"
#include "radioslam/rendezvous/rendezvous_robot.hpp"

namespace radioslam {

RobotSession::RobotSession(std::string id, const RendezvousParams& params)
    : id_(std::move(id)), params_(params) {
  if (!is_robot_name(id_))
    throw InputError("robot '" + id_.substr(0, kLongestName) + "'", 0,
                     "is not a name of 1 to " + std::to_string(kLongestName) + " bytes other than *");
}

RobotSession::~RobotSession() = default;

std::vector<std::string> RobotSession::line(std::string_view text) {
  ++lines_;
  try {
    if (text.size() > kLongestLine_bytes) refuse_json("longer than 1 MiB");
    if (text.find_first_not_of(" \t\r") == std::string_view::npos) return {};
    if (finished_) refuse_json("the robot has finished");
    return std::visit([this](const auto& event) { return answer(event); }, read_robot_event(text));
  } catch (const InputError& error) {
    return {format_line_error(lines_, error.reason())};
  }
}

std::vector<std::string> RobotSession::end() {
  if (!robot_ || finished_) return {};
  return answer(Finish{});
}

RendezvousRobot& RobotSession::started() {
  if (!robot_) refuse_json("the robot has not started");
  return *robot_;
}

/// The robot at the time of an event.
RendezvousRobot& RobotSession::at(double t_s) {
  RendezvousRobot& robot = started();
  if (t_s < now_s_) refuse_json("'t_s' is before that of an earlier line");
  now_s_ = t_s;
  return robot;
}

std::vector<std::string> RobotSession::answer(const RobotStart& start) {
  if (robot_) refuse_json("the robot has started already");
  robot_ = std::make_unique<RendezvousRobot>(id_, start, params_);
  now_s_ = start.t_s;
  return {};
}

std::vector<std::string> RobotSession::answer(const OdometryStep& step) {
  at(step.t_s).move(step);
  return {};
}

std::vector<std::string> RobotSession::answer(const SeenRobot& seen) {
  at(seen.t_s).see(seen);
  return {};
}

std::vector<std::string> RobotSession::answer(const HeardPacket& packet) {
  at(packet.t_s).hear(packet);
  return {};
}

std::vector<std::string> RobotSession::answer(const ObstacleAhead& obstacle) {
  at(obstacle.t_s).meet_obstacle(obstacle);
  return {};
}

std::vector<std::string> RobotSession::answer(const DecisionTick& tick) {
  return format_answer(at(tick.t_s).tick(tick));
}

std::vector<std::string> RobotSession::answer(const Finish& /*finish*/) {
  std::string trajectory = format_trajectory(started().finish());
  finished_ = true;
  return {std::move(trajectory)};
}

}  // namespace radioslam
