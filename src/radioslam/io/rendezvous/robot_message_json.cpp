#include "radioslam/io/rendezvous/robot_message_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include "radioslam/base/base64.hpp"
#include "radioslam/io/rendezvous/json_values.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::json;
using Output = nlohmann::ordered_json;

constexpr const char* kFormat = "radioslam-rendezvous/2";
constexpr int kDigits = 9;
constexpr auto kAnyCount = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kAnyNumber32 = std::numeric_limits<std::uint32_t>::max();

// ---- writing --------------------------------------------------------------------------------------------

double rounded(double value) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, kDigits).ptr;
  std::from_chars(text.data(), end, value);
  return value;
}

Output pose_json(const SE2& pose) {
  Output row = Output::array();
  for (const double value : {pose.translation().x(), pose.translation().y(), pose.angle()})
    row.push_back(rounded(value));
  return row;
}

/// Members that say nothing are left out.
void add_name(Output& json, const char* member, const std::string& name) {
  if (!name.empty()) json[member] = name;
}

/// The binding fails to compile where a status has a field that is not written.
Output status_json(const RobotStatus& status) {
  const auto& [number, error, frame, pose, sigma_m, call, call_error, alpha, partner, offer_to, serving,
               standing, leans_on, walked_m, knows] = status;
  Output json{{"number", number},
              {"error", rounded(std::min(error, kNotNegative.largest))},
              {"pose", pose_json(pose)},
              {"sigma_m", rounded(sigma_m)}};
  add_name(json, "frame", frame);
  if (call) {
    json["call"] = *call;
    json["call_error"] = rounded(std::min(call_error, kNotNegative.largest));
    json["alpha"] = rounded(std::min(alpha, kNotNegative.largest));
  }
  add_name(json, "partner", partner);
  add_name(json, "offer_to", offer_to);
  add_name(json, "serving", serving);
  if (standing) json["standing"] = true;
  add_name(json, "leans_on", leans_on);
  json["walked_m"] = rounded(std::min(walked_m, kNotNegative.largest));
  Output& known = json["knows"] = Output::object();
  for (const auto& [robot, version] : knows) known[robot] = {version.life, version.records, version.until_s};
  return json;
}

// ---- reading --------------------------------------------------------------------------------------------

std::map<std::string, LogVersion> read_versions(const JsonObject& from, const char* member) {
  const Json& json = from.at(member);
  if (!json.is_object()) from.fail(member, "an object");
  std::map<std::string, LogVersion> versions;
  for (auto each = json.begin(); each != json.end(); ++each) {
    if (!is_robot_name(each.key())) from.fail(member, "an object of what is known by robots' names");
    JsonRow row(each.value(), "a version", 3);
    LogVersion& version = versions[each.key()];
    version.life = static_cast<std::uint32_t>(row.whole_number(kAnyNumber32));
    version.records = row.whole_number(kAnyCount);
    version.until_s = row.number(kSeconds);
  }
  return versions;
}

std::string name_in(const JsonObject& from, const char* member) {
  return from.has(member) ? from.robot_or_none(member) : "";
}

RobotStatus read_status(const Json& json) {
  const JsonObject from(json, "the status");
  RobotStatus status;
  status.number = from.whole_number("number", kAnyCount);
  status.error = from.number("error", kNotNegative);
  status.frame = name_in(from, "frame");
  status.pose = from.pose("pose");
  status.sigma_m = from.number("sigma_m", kNotNegative);
  if (from.has("call")) status.call = static_cast<std::uint32_t>(from.whole_number("call", kAnyNumber32));
  if (status.call) status.call_error = from.number("call_error", kNotNegative);
  if (from.has("alpha")) status.alpha = from.number("alpha", kNotNegative);
  status.partner = name_in(from, "partner");
  status.offer_to = name_in(from, "offer_to");
  status.serving = name_in(from, "serving");
  status.standing = from.has("standing") && from.flag("standing");
  status.leans_on = name_in(from, "leans_on");
  status.walked_m = from.number("walked_m", kNotNegative);
  status.knows = read_versions(from, "knows");
  return status;
}

}  // namespace

Output message_json(const RobotMessage& message) {
  Output json{{"format", kFormat}};
  if (message.status) json["status"] = status_json(*message.status);
  if (!message.records.empty()) json["records"] = base64(message.records);
  return json;
}

RobotMessage read_message(const Json& json) {
  const JsonObject from(json, "the message");
  if (from.at("format") != kFormat) from.fail("format", std::string("'") + kFormat + "'");
  RobotMessage message;
  if (from.has("status")) message.status = read_status(from.at("status"));
  if (!from.has("records")) return message;
  const Json& text = from.at("records");
  auto bytes = text.is_string() ? bytes_of_base64(text.get_ref<const std::string&>()) : std::nullopt;
  if (!bytes) from.fail("records", "base64");
  message.records = std::move(*bytes);
  return message;
}

}  // namespace radioslam
