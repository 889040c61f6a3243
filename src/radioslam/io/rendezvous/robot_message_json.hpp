// Messages between robots as JSON:
//
//   {"format": "radioslam-rendezvous/1", "status": {...}, "parts": [{...}, ...]}
//
// without a status, or without parts, where there are none. Rows of a part:
//   nodes         [number, t_s, until_s, x, y, yaw, l11, l21, l22, l31, l32, l33]
//   observations     [node, other, t_s, x, y, yaw, sigma_m, sigma_rad, log_odds, scale]
//   angle_checks  [other, t_s, log_odds, scale]
// where `other` is a place in the part's list `others` of names, and L L^T the covariance of a node's step:
// as that of a factor, it stays positive definite when numbers are rounded. Numbers have nine significant
// digits, but times are exact, since observations are found by them.
#pragma once

#include <nlohmann/json.hpp>

#include "radioslam/rendezvous/robot_message.hpp"

namespace radioslam {

nlohmann::ordered_json message_json(const RobotMessage& message);

/// Refuses (InputError) what message_json did not write, and parts that are not well-formed.
RobotMessage read_message(const nlohmann::json& json);

}  // namespace radioslam
