// The lines by which a robot of `radioslam rendezvous --stdio` is driven from outside: one JSON object each.
// Protocol: docs/formats.md.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "radioslam/rendezvous/robot_interface.hpp"
#include "radioslam/rendezvous/robot_message.hpp"

namespace radioslam {

/// The run is over.
struct Finish {};

using RobotEvent =
    std::variant<RobotStart, OdometryStep, SeenRobot, HeardPacket, ObstacleAhead, DecisionTick, Finish>;

/// Refuses (InputError) unknown events and members, missing ones, wrong types and implausible numbers.
RobotEvent read_robot_event(std::string_view line);

/// Largest message between robots (protocol).
inline constexpr std::size_t kLargestMessage_bytes = 65536;

/// What a robot sends, its movement, and its state. A message that is too large is left out.
std::vector<std::string> format_answer(const TickAnswer& answer);
std::string format_trajectory(const FinalTrajectory& trajectory);
/// `line` counts from 1.
std::string format_line_error(std::size_t line, const std::string& reason);

}  // namespace radioslam
