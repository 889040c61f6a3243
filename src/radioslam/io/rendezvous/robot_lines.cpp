#include "radioslam/io/rendezvous/robot_lines.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "radioslam/base/suggestion.hpp"
#include "radioslam/io/rendezvous/json_values.hpp"
#include "radioslam/io/rendezvous/robot_message_json.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::json;
using Output = nlohmann::ordered_json;

constexpr auto kLargestKappa = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
constexpr double kSmallestSigma_rad = 1e-6;  ///< of a direction that is stated to be exact

// ---- events ---------------------------------------------------------------------------------------------

RobotEvent read_start(const Json& json) {
  const JsonObject from(json, "start");
  RobotStart start;
  start.t_s = from.number("t_s", kSeconds);
  if (from.has("pose")) start.pose = from.pose("pose");
  if (from.has("q_db")) start.q_db = from.number("q_db", kPositive);
  if (from.has("delta")) start.delta = from.number("delta", kNotNegative);
  if (from.has("max_step_m")) start.max_step_m = from.number("max_step_m", kPositive);
  if (from.has("kappa")) start.kappa = static_cast<int>(from.whole_number("kappa", kLargestKappa));
  if (start.kappa && *start.kappa < 1) from.fail("kappa", "at least 1");
  from.refuse_misspelt();
  return start;
}

RobotEvent read_odometry(const Json& json) {
  const JsonObject from(json, "odometry");
  OdometryStep step;
  step.t_s = from.number("t_s", kSeconds);
  step.T_previous_body = from.pose("T_previous_body");
  step.sigma_m = from.number("sigma_m", kNotNegative);
  step.sigma_rad = from.number("sigma_rad", kNotNegative);
  from.refuse_misspelt();
  return step;
}

RobotEvent read_seen(const Json& json) {
  const JsonObject from(json, "seen");
  SeenRobot seen;
  seen.t_s = from.number("t_s", kSeconds);
  seen.robot = from.robot("robot");
  seen.T_i_j = from.pose("T_i_j");
  seen.sigma_m = from.number("sigma_m", kNotNegative);
  seen.sigma_rad = from.number("sigma_rad", kNotNegative);
  from.refuse_misspelt();
  return seen;
}

ArrivalPath read_path(const Json& json) {
  const JsonObject from(json, "a path");
  ArrivalPath path;
  path.azimuth_rad = from.number("azimuth_rad");
  path.sigma_rad = std::max(from.number("sigma_rad", kNotNegative), kSmallestSigma_rad);
  path.power_db = from.number("power_db", kDecibels);
  from.refuse_misspelt();
  return path;
}

RobotEvent read_packet(const Json& json) {
  const JsonObject from(json, "packet");
  HeardPacket packet;
  packet.t_s = from.number("t_s", kSeconds);
  packet.from = from.robot("from");
  packet.esnr_db = from.number("esnr_db", kDecibels);
  for (const Json& path : from.list("paths")) packet.paths.push_back(read_path(path));
  if (from.has("message"))
    packet.message = std::make_shared<const RobotMessage>(read_message(from.at("message")));
  from.refuse_misspelt();
  return packet;
}

RobotEvent read_obstacle(const Json& json) {
  const JsonObject from(json, "obstacle");
  const ObstacleAhead obstacle{from.number("t_s", kSeconds), from.number("azimuth_rad"),
                               from.number("distance_m", kNotNegative)};
  from.refuse_misspelt();
  return obstacle;
}

RobotEvent read_tick(const Json& json) {
  const JsonObject from(json, "tick");
  const DecisionTick tick{from.number("t_s", kSeconds), from.has("talk") && from.flag("talk")};
  from.refuse_misspelt();
  return tick;
}

RobotEvent read_finish(const Json& json) {
  const JsonObject from(json, "finish");
  return Finish{};
}

struct EventReader {
  std::string_view event;
  RobotEvent (*read)(const Json&);
};

constexpr std::array kReaders = std::to_array<EventReader>({{"start", read_start},
                                                            {"odometry", read_odometry},
                                                            {"seen", read_seen},
                                                            {"packet", read_packet},
                                                            {"obstacle", read_obstacle},
                                                            {"tick", read_tick},
                                                            {"finish", read_finish}});

[[noreturn]] void refuse_event(const std::string& name) {
  std::vector<std::string> known;
  for (const EventReader& reader : kReaders) known.emplace_back(reader.event);
  const std::string shown = name.substr(0, kLongestName);
  refuse_json("unknown event '" + shown + "'" + did_you_mean(shown, known));
}

// ---- answers --------------------------------------------------------------------------------------------

/// On one line; numbers that are not finite become null, bytes that are not UTF-8 a replacement.
std::string text_of(const Output& json) {
  return json.dump(-1, ' ', false, Output::error_handler_t::replace);
}

std::string line_of(const char* name, Output content) {
  Output json;
  json[name] = std::move(content);
  return text_of(json);
}

/// Bytes of a message where it is written with a blank after every comma and colon.
std::size_t size_of(const std::string& message) {
  const auto separators =
      std::count_if(message.begin(), message.end(), [](char c) { return c == ',' || c == ':'; });
  return message.size() + static_cast<std::size_t>(separators);
}

void append_messages(const std::vector<OutgoingMessage>& messages, std::vector<std::string>& lines) {
  for (const OutgoingMessage& each : messages) {
    Output message = message_json(*each.message);
    if (size_of(text_of(message)) > kLargestMessage_bytes) continue;
    lines.push_back(line_of("send", {{"to", each.to.empty() ? "*" : each.to},
                                     {"kind", each.reach == Reach::kData ? "data" : "control"},
                                     {"message", std::move(message)}}));
  }
}

std::string movement_line(const Movement& movement) {
  switch (movement.kind) {
    case Movement::Kind::kMove:
      return line_of("move", {{"x_m", movement.target.x()}, {"y_m", movement.target.y()}});
    case Movement::Kind::kStay:
      return line_of("stay", Output::object());
    case Movement::Kind::kExplore:
      return line_of("explore", Output::object());
  }
  return {};
}

Output name_or_null(const std::string& name) { return name.empty() ? Output() : Output(name); }

std::string state_line(const RobotState& state) {
  return line_of("state", {{"error", state.error},
                           {"sigma_m", state.sigma_m},
                           {"asking", state.asking},
                           {"serving", name_or_null(state.serving)},
                           {"team", state.team}});
}

}  // namespace

RobotEvent read_robot_event(std::string_view line) {
  const Json json = parse_json(line);
  if (!json.is_object() || json.size() != 1) refuse_json("not an object of one event");
  const auto event = json.begin();
  const auto reader = std::find_if(kReaders.begin(), kReaders.end(),
                                   [&](const EventReader& each) { return each.event == event.key(); });
  if (reader == kReaders.end()) refuse_event(event.key());
  return reader->read(event.value());
}

std::vector<std::string> format_answer(const TickAnswer& answer) {
  std::vector<std::string> lines;
  append_messages(answer.messages, lines);
  if (answer.movement) lines.push_back(movement_line(*answer.movement));
  lines.push_back(state_line(answer.state));
  return lines;
}

std::string format_trajectory(const FinalTrajectory& trajectory) {
  Output json, &rows = json["trajectory"] = Output::array();
  for (const FinalTrajectory::Row& row : trajectory.rows)
    rows.push_back({row.t_s, row.pose.translation().x(), row.pose.translation().y(), row.pose.angle()});
  json["frame"] = trajectory.frame.empty() ? "common" : trajectory.frame;
  Output& measurements = json["measurements"] = Output::array();
  for (const FinalTrajectory::Measurement& each : trajectory.measurements)
    measurements.push_back({{"t_s", each.t_s}, {"robot", each.robot}, {"weight", each.weight}});
  return text_of(json);
}

std::string format_line_error(std::size_t line, const std::string& reason) {
  return line_of("error", {{"line", line}, {"reason", reason}});
}

}  // namespace radioslam
