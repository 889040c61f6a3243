#include "radioslam/io/rendezvous/robot_message_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/io/rendezvous/json_values.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::json;
using Output = nlohmann::ordered_json;

constexpr const char* kFormat = "radioslam-rendezvous/1";
constexpr int kDigits = 9;
constexpr std::size_t kNodeValues = 12, kObservationValues = 10, kEvidenceValues = 4;
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

void append_pose(Output& row, const SE2& pose) {
  for (const double value : {pose.translation().x(), pose.translation().y(), pose.angle()})
    row.push_back(rounded(value));
}

/// Zeros for one that is not positive definite, as that of a start.
void append_covariance(Output& row, const SE2::Jacobian& covariance) {
  const Cholesky<SE2::Jacobian> cholesky(covariance);
  SE2::Jacobian factor = SE2::Jacobian::Zero();
  if (cholesky.succeeded()) factor = cholesky.lower();
  for (int i = 0; i < SE2::kDof; ++i)
    for (int j = 0; j <= i; ++j) row.push_back(rounded(factor(i, j)));
}

void append_evidence(Output& row, const AngleEvidence& evidence) {
  row.push_back(rounded(evidence.log_odds));
  row.push_back(rounded(evidence.scale));
}

Output pose_json(const SE2& pose) {
  Output row = Output::array();
  append_pose(row, pose);
  return row;
}

/// Names of the robots that a part refers to, each once.
class OtherRobots {
 public:
  std::size_t place_of(const std::string& name) {
    const auto [at, is_new] = places_.try_emplace(name, names_.size());
    if (is_new) names_.push_back(name);
    return at->second;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::map<std::string, std::size_t> places_;
  std::vector<std::string> names_;
};

Output nodes_json(const SharedPart& part) {
  Output rows = Output::array();
  for (const SharedNode& node : part.nodes) {
    Output& row = rows.emplace_back(Output::array({node.number, node.t_s, node.until_s}));
    append_pose(row, node.from_before.pose);
    append_covariance(row, node.from_before.covariance);
  }
  return rows;
}

Output observations_json(const SharedPart& part, OtherRobots& others) {
  Output rows = Output::array();
  for (const SharedObservation& observation : part.observations) {
    Output& row = rows.emplace_back(
        Output::array({observation.node, others.place_of(observation.robot), observation.t_s}));
    append_pose(row, observation.T_i_j);
    row.push_back(rounded(observation.sigma_m));
    row.push_back(rounded(observation.sigma_rad));
    append_evidence(row, observation.evidence);
  }
  return rows;
}

Output evidence_json(const SharedPart& part, OtherRobots& others) {
  Output rows = Output::array();
  for (const SharedEvidence& evidence : part.evidence) {
    Output& row = rows.emplace_back(Output::array({others.place_of(evidence.by), evidence.t_s}));
    append_evidence(row, evidence.angles);
  }
  return rows;
}

Output part_json(const SharedPart& part) {
  OtherRobots others;
  Output json{{"robot", part.robot}, {"version", part.version}};
  if (part.start) json["start"] = pose_json(*part.start);
  json["nodes"] = nodes_json(part);
  json["observations"] = observations_json(part, others);
  json["angle_checks"] = evidence_json(part, others);
  json["others"] = others.names();
  return json;
}

/// The binding fails to compile where a status has a field that is not written.
Output status_json(const RobotStatus& status) {
  const auto& [number, error, frame, pose, sigma_m, call, call_error, alpha, partner, offer_to, serving,
               standing, leans_on, walked_m, knows] = status;
  Output json{{"number", number},
              {"error", rounded(std::min(error, kNotNegative.largest))},
              {"frame", frame},
              {"pose", pose_json(pose)},
              {"sigma_m", rounded(sigma_m)}};
  if (call) json["call"] = *call;
  json["call_error"] = rounded(std::min(call_error, kNotNegative.largest));
  json["alpha"] = rounded(std::min(alpha, kNotNegative.largest));
  json["partner"] = partner;
  json["offer_to"] = offer_to;
  json["serving"] = serving;
  json["standing"] = standing;
  json["leans_on"] = leans_on;
  json["walked_m"] = rounded(std::min(walked_m, kNotNegative.largest));
  json["knows"] = Output(knows);
  return json;
}

// ---- reading --------------------------------------------------------------------------------------------

SE2::Jacobian read_covariance(JsonRow& row) {
  SE2::Jacobian factor = SE2::Jacobian::Zero();
  for (int i = 0; i < SE2::kDof; ++i)
    for (int j = 0; j <= i; ++j) factor(i, j) = row.number();
  return factor * factor.transpose();
}

AngleEvidence read_evidence(JsonRow& row) {
  AngleEvidence evidence;
  evidence.log_odds = row.number();
  evidence.scale = row.number();
  return evidence;
}

SharedNode read_node(const Json& json) {
  JsonRow row(json, "a node", kNodeValues);
  SharedNode node;
  node.number = static_cast<std::uint32_t>(row.whole_number(kAnyNumber32));
  node.t_s = row.number(kSeconds);
  node.until_s = row.number(kSeconds);
  node.from_before.pose = row.pose();
  node.from_before.covariance = read_covariance(row);
  return node;
}

const std::string& read_other(JsonRow& row, const std::vector<std::string>& others) {
  if (others.empty()) refuse_json("a part refers to robots that it does not name");
  return others[static_cast<std::size_t>(row.whole_number(others.size() - 1))];
}

SharedObservation read_observation(const Json& json, const std::vector<std::string>& others) {
  JsonRow row(json, "an observation", kObservationValues);
  SharedObservation observation;
  observation.node = static_cast<std::uint32_t>(row.whole_number(kAnyNumber32));
  observation.robot = read_other(row, others);
  observation.t_s = row.number(kSeconds);
  observation.T_i_j = row.pose();
  observation.sigma_m = row.number();
  observation.sigma_rad = row.number();
  observation.evidence = read_evidence(row);
  return observation;
}

SharedEvidence read_shared_evidence(const Json& json, const std::vector<std::string>& others) {
  JsonRow row(json, "an angle check", kEvidenceValues);
  SharedEvidence evidence;
  evidence.by = read_other(row, others);
  evidence.t_s = row.number(kSeconds);
  evidence.angles = read_evidence(row);
  return evidence;
}

std::vector<std::string> read_names(const JsonObject& from, const char* member) {
  std::vector<std::string> names;
  for (const Json& name : from.list(member)) {
    if (!name.is_string() || !is_robot_name(name.get_ref<const std::string&>()))
      from.fail(member, "a list of robots' names");
    names.push_back(name.get<std::string>());
  }
  return names;
}

SharedPart read_part(const Json& json) {
  const JsonObject from(json, "a part");
  SharedPart part;
  part.robot = from.robot("robot");
  part.version = from.whole_number("version", kAnyCount);
  if (from.has("start")) part.start = from.pose("start");
  for (const auto& [member, most] :
       {std::pair{"others", 2 * kMaxSharedEntries}, std::pair{"nodes", kMaxSharedNodes},
        std::pair{"observations", kMaxSharedEntries}, std::pair{"angle_checks", kMaxSharedEntries}})
    if (from.list(member).size() > most) from.fail(member, "a list of up to " + std::to_string(most));
  const auto others = read_names(from, "others");
  for (const Json& node : from.list("nodes")) part.nodes.push_back(read_node(node));
  for (const Json& each : from.list("observations"))
    part.observations.push_back(read_observation(each, others));
  for (const Json& each : from.list("angle_checks"))
    part.evidence.push_back(read_shared_evidence(each, others));
  if (!is_well_formed(part)) refuse_json("the part of " + part.robot + " is not well-formed");
  return part;
}

std::map<std::string, std::uint64_t> read_versions(const JsonObject& from, const char* member) {
  const Json& json = from.at(member);
  if (!json.is_object()) from.fail(member, "an object");
  std::map<std::string, std::uint64_t> versions;
  for (auto each = json.begin(); each != json.end(); ++each) {
    if (!is_robot_name(each.key()) || !each.value().is_number_unsigned())
      from.fail(member, "an object of versions by robots' names");
    versions[each.key()] = each.value().get<std::uint64_t>();
  }
  return versions;
}

RobotStatus read_status(const Json& json) {
  const JsonObject from(json, "the status");
  RobotStatus status;
  status.number = from.whole_number("number", kAnyCount);
  status.error = from.number("error", kNotNegative);
  status.frame = from.robot_or_none("frame");
  status.pose = from.pose("pose");
  status.sigma_m = from.number("sigma_m", kNotNegative);
  if (from.has("call")) status.call = static_cast<std::uint32_t>(from.whole_number("call", kAnyNumber32));
  status.call_error = from.number("call_error", kNotNegative);
  if (from.has("alpha")) status.alpha = from.number("alpha", kNotNegative);
  status.partner = from.robot_or_none("partner");
  status.offer_to = from.robot_or_none("offer_to");
  status.serving = from.robot_or_none("serving");
  status.standing = from.flag("standing");
  status.leans_on = from.robot_or_none("leans_on");
  status.walked_m = from.number("walked_m", kNotNegative);
  status.knows = read_versions(from, "knows");
  return status;
}

}  // namespace

Output message_json(const RobotMessage& message) {
  Output json{{"format", kFormat}};
  if (message.status) json["status"] = status_json(*message.status);
  if (message.parts.empty()) return json;
  Output& parts = json["parts"] = Output::array();
  for (const auto& part : message.parts) parts.push_back(part_json(*part));
  return json;
}

RobotMessage read_message(const Json& json) {
  const JsonObject from(json, "the message");
  if (from.at("format") != kFormat) from.fail("format", std::string("'") + kFormat + "'");
  RobotMessage message;
  if (from.has("status")) message.status = read_status(from.at("status"));
  if (!from.has("parts")) return message;
  for (const Json& part : from.list("parts"))
    message.parts.push_back(std::make_shared<const SharedPart>(read_part(part)));
  return message;
}

}  // namespace radioslam
