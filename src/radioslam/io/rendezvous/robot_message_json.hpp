// Messages between robots as JSON:
//
//   {"format": "radioslam-rendezvous/2", "status": {...}, "records": "..."}
//
// without a status, or without records, where there are none. Records are chunks of robots' logs in base64.
// Numbers have nine significant digits, but times are exact, since sightings are placed by them.
#pragma once

#include <nlohmann/json.hpp>

#include "radioslam/rendezvous/robot_message.hpp"

namespace radioslam {

nlohmann::ordered_json message_json(const RobotMessage& message);

/// Refuses (InputError) what message_json did not write. What is in the records, nobody looks at here.
RobotMessage read_message(const nlohmann::json& json);

}  // namespace radioslam
