#include "radioslam/io/run/run_folder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/run/run_tables.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kIndent = 2;

/// The status of an RSSI offset as text; null if none was estimated.
const char* rssi_offset_text(RssiOffsetStatus offset) {
  switch (offset) {
    case RssiOffsetStatus::kNotSought:
      return nullptr;
    case RssiOffsetStatus::kNotObserved:
      return "not observed";
    case RssiOffsetStatus::kNotSignificant:
      return "not shown";
    case RssiOffsetStatus::kCorrected:
      return "taken off";
  }
  return nullptr;
}

Json fixes_json(const FixResult& fixes) {
  Json json = {{"used", fixes.used}, {"rejected", fixes.rejected}, {"outside", fixes.outside}};
  json["place_it"] = fixes.place;
  if (!fixes.unused.empty()) json["unused"] = fixes.unused;
  return json;
}

Json robot_json(const RobotResult& robot) {
  Json json = {{"keyframes", robot.estimate.size()},
               {"placed", robot.placed},
               {"yaw_drift_per_m_rad", robot.yaw_drift_per_m_rad},
               {"scale_error", robot.scale_error}};
  if (const char* text = rssi_offset_text(robot.rssi_offset)) json["rssi_offset"] = text;
  if (robot.sigma_rssi_offset_db) {
    json["rssi_offset_db"] = robot.rssi_offset_db;
    json["sigma_rssi_offset_db"] = *robot.sigma_rssi_offset_db;
  }
  if (robot.fixes) json["fixes"] = fixes_json(*robot.fixes);
  json["uncertain"] = Json::array();
  for (const auto& [first, last] : robot.uncertain)
    json["uncertain"].push_back({first.seconds(), last.seconds()});
  if (!robot.untied.empty()) json["not_placed"] = Json::array();
  for (const UntiedStretch& stretch : robot.untied)
    json["not_placed"].push_back({stretch.first.seconds(), stretch.last.seconds()});
  if (!robot.sigma_position_m.empty()) {
    json["start_sigma_m"] = robot.sigma_position_m.front();
    json["sigma_position_end_m"] = robot.sigma_position_m.back();
  }
  return json;
}

/// A parameter's text as a JSON value of its type.
Json parameter_json(const std::string& value) {
  if (value == "true" || value == "false") return value == "true";
  if (const auto integer = parse_integer(value)) return *integer;
  if (const auto number = parse_number(value)) return *number;
  return value;
}

/// A count as an integer if it is one.
Json count_json(double count) {
  constexpr double kLargestExact = 9e15;  // below it every integer is a double
  const bool is_whole = std::abs(count) < kLargestExact && std::trunc(count) == count;
  return is_whole ? Json(static_cast<std::int64_t>(count)) : Json(count);
}

Json transform_json(const TransformResult& transform) {
  const Eigen::Vector3d t = transform.T_i_j.translation();
  const Eigen::Quaterniond q = transform.T_i_j.rotation();
  Json covariance = Json::array();
  for (const auto& row : transform.covariance.rowwise())
    covariance.push_back(std::vector<double>(row.begin(), row.end()));
  return {{"robot_i", transform.robot_i},
          {"robot_j", transform.robot_j},
          {"translation_m", {t.x(), t.y(), t.z()}},
          {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"covariance", std::move(covariance)}};
}

Json team_frame_json(const RunResult& result) {
  Json json = {{"components", Json::array()}, {"unplaced", result.unplaced}, {"hypotheses", Json::array()}};
  for (const Component& component : result.components) json["components"].push_back(component.robots);
  json["hypotheses"].push_back({{"weight", result.weight}});
  for (const HypothesisResult& other : result.alternatives)
    json["hypotheses"].push_back({{"weight", other.weight}});
  json["transforms"] = Json::array();
  for (const TransformResult& transform : result.transforms)
    json["transforms"].push_back(transform_json(transform));
  return json;
}

Json range_biases_json(const RunResult& result) {
  Json json = Json::array();
  for (const RangeBiasResult& bias : result.range_biases)
    json.push_back({{"end_i", bias.end_i},
                    {"end_j", bias.end_j},
                    {"bias_m", bias.bias_m},
                    {"sigma_m", bias.sigma_m},
                    {"ranges", bias.ranges}});
  return json;
}

Json loop_choice_json(const LoopChoiceResult& choice) {
  Json json = {{"cost", choice.cost}, {"trials", Json::array()}};
  for (const LoopTrialResult& trial : choice.trials)
    json["trials"].push_back({{"robots", trial.robots},
                              {"loops", trial.loops},
                              {"held", trial.held},
                              {"cost", trial.cost},
                              {"taken", trial.taken}});
  return json;
}

Json angle_checks_json(const RunResult& result) {
  Json json = Json::array();
  for (const AoaIntegrityResult& check : result.angle_checks)
    json.push_back({{"receiver", check.receiver},
                    {"transmitter", check.transmitter},
                    {"pose", check.pose == CheckedPose::kSelfReported ? "claim" : "estimate"},
                    {"measurements", check.measurements},
                    {"median_weight", check.median_weight},
                    {"share_beyond", check.outlier_ratio},
                    {"chance", check.p_value},
                    {"contradicted", check.contradicted}});
  return json;
}

std::vector<std::string> ids_of(const RunResult& result) {
  std::vector<std::string> ids;
  for (const RobotResult& robot : result.robots) ids.push_back(robot.id);
  return ids;
}

void write_trajectories(const std::filesystem::path& folder, const std::vector<RobotResult>& robots) {
  for (const RobotResult& robot : robots) {
    const std::string name = robot.id + ".tum";
    if (!robot.estimate.empty()) write_file(folder / name, format_tum(robot.estimate));
    if (!robot.dense.empty()) write_file(folder / "dense" / name, format_tum(robot.dense));
  }
}

namespace fs = std::filesystem;

/// The member `key` of an object; null if there is none.
const Json& member(const Json& json, const char* key) {
  static const Json none;
  if (!json.is_object()) return none;
  const auto found = json.find(key);
  return found == json.end() ? none : *found;
}

std::vector<std::string> strings_in(const Text& text, const Json& list, const char* what) {
  std::vector<std::string> result;
  if (list.is_null()) return result;
  const auto is_string = [](const Json& entry) { return entry.is_string(); };
  if (!list.is_array() || !std::all_of(list.begin(), list.end(), is_string))
    text.fail(1, std::string(what) + " must be a list of robots");
  for (const Json& entry : list) result.push_back(entry.get<std::string>());
  return result;
}

void read_team_frame(const Text& text, RunFolder& run) {
  const Json& frame = member(run.summary, "team_frame");
  run.unplaced = strings_in(text, member(frame, "unplaced"), "unplaced");
  const Json& components = member(frame, "components");
  if (components.is_null()) return;
  if (!components.is_array()) text.fail(1, "components must be a list");
  for (const Json& entry : components) run.components.push_back({strings_in(text, entry, "a component")});
}

std::vector<std::string> robots_in_summary(const Text& text, const Json& summary) {
  const Json& robots = member(summary, "robots");
  if (!robots.is_object()) text.fail(1, "'robots' is missing");
  std::vector<std::string> ids;
  for (const auto& entry : robots.items()) ids.push_back(entry.key());
  return ids;
}

std::vector<std::string> robots_with_file(const fs::path& folder) {
  std::vector<std::string> ids;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".tum")
      ids.push_back(entry.path().stem().string());
  std::sort(ids.begin(), ids.end());
  if (ids.empty())
    throw InputError(folder.string(), 0, "is not a run: it has no summary.json and no .tum file");
  return ids;
}

/// Stretches of a robot without poses, in seconds, widened by the rounding of a double.
std::vector<std::pair<Stamp, Stamp>> untied_in(const Json& robot) {
  constexpr double kRounding_s = 1e-6, kMax_s = 9e9;
  std::vector<std::pair<Stamp, Stamp>> result;
  for (const Json& entry : member(robot, "not_placed")) {
    const auto at = [&](std::size_t k, double slack_s) {
      const bool is_number = entry.is_array() && entry.size() == 2 && entry[k].is_number();
      const double t_s = is_number ? entry[k].get<double>() + slack_s : 0;
      return Stamp::from_seconds(std::clamp(t_s, -kMax_s, kMax_s));
    };
    result.emplace_back(at(0, -kRounding_s), at(1, kRounding_s));
  }
  return result;
}

void read_trajectories(const fs::path& folder, const std::vector<std::string>& ids, RunFolder& run) {
  for (const std::string& id : ids) {
    EstimatedTrajectory& robot = run.robots.emplace_back();
    robot.id = id;
    robot.untied = untied_in(member(member(run.summary, "robots"), id.c_str()));
    if (id.find('/') != std::string::npos)
      throw InputError(folder.string(), 0, "the robot's id '" + id + "' contains a path");
    const bool unplaced = std::find(run.unplaced.begin(), run.unplaced.end(), id) != run.unplaced.end();
    const fs::path path = folder / (id + ".tum");
    if (!unplaced || fs::exists(path)) robot.poses = read_tum(read_text(path));
  }
}

/// The run searched for candidates if there are rows, or a count in its summary, or a file without a summary.
void read_candidates_of(const fs::path& folder, RunFolder& run) {
  if (!fs::exists(folder / "candidates.csv")) return;
  auto candidates = read_candidates(read_text(folder / "candidates.csv"), run.robots);
  const bool counted = !member(member(run.summary, "counts"), "candidates").is_null();
  if (!candidates.empty() || counted || run.summary.is_null()) run.candidates = std::move(candidates);
}

/// `bytes` and `rounds` of what robots sent each other, and what their logs take.
void add_exchange(Json& json, const ExchangeResult& exchange, const std::vector<RobotResult>& robots) {
  for (std::size_t r = 0; r < robots.size(); ++r) {
    for (const auto& [kind, bytes] : exchange.bytes[r]) json["bytes"][robots[r].id][kind] = bytes;
    if (!exchange.log_bytes.empty()) json["log_bytes"][robots[r].id] = exchange.log_bytes[r];
  }
  json["rounds"] = exchange.rounds;
}

}  // namespace

Json summary_json(const RunResult& result, const Json& metrics) {
  Json json = {{"mission", result.mission_name}, {"dimension", result.dimension}};
  for (const char* section : {"robots", "counts", "seconds", "parameters"}) json[section] = Json::object();
  for (const RobotResult& robot : result.robots) json["robots"][robot.id] = robot_json(robot);
  for (const auto& [name, count] : result.counts) json["counts"][name] = count_json(count);
  for (const StageTiming& timing : result.timings) json["seconds"][timing.stage] = timing.seconds;
  for (const EffectiveParameter& parameter : result.parameters)
    json["parameters"][parameter.key] = parameter_json(parameter.value);
  json["team_frame"] = team_frame_json(result);
  json["range_biases"] = range_biases_json(result);
  if (result.exchange) add_exchange(json, *result.exchange, result.robots);
  if (result.loop_choice) json["loop_choice"] = loop_choice_json(*result.loop_choice);
  json["angle_checks"] = angle_checks_json(result);
  json["notes"] = result.notes;
  if (!metrics.is_null()) json["metrics"] = metrics;
  return json;
}

void write_run(const std::filesystem::path& folder, const RunResult& result, const RunDocuments& documents) {
  const std::vector<std::string> ids = ids_of(result);
  write_trajectories(folder, result.robots);
  for (std::size_t k = 0; k < result.alternatives.size(); ++k)
    write_trajectories(folder / "hypotheses" / std::to_string(k + 1), result.alternatives[k].robots);
  if (documents.candidates == CandidateTable::kOfResult)
    write_candidates(folder / "candidates.csv", result.candidates, ids);
  write_file(folder / "closures.csv", format_closures(result.closures, ids));
  write_file(folder / "uncertainty.csv", format_uncertainty(result.robots));
  if (!result.aoa_measurements.empty())
    write_file(folder / "aoa.csv", format_measured_aoa(result.aoa_measurements));
  if (!result.access_points.empty())
    write_file(folder / "access_points.csv", format_access_points(result.access_points));
  if (!documents.graph_g2o.empty()) write_file(folder / "graph.g2o", documents.graph_g2o);
  if (!documents.report_html.empty()) write_file(folder / "report.html", documents.report_html);
  Json summary = summary_json(result, documents.metrics);
  if (!documents.summary.is_null()) summary.update(documents.summary);
  write_file(folder / "summary.json",
             summary.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n");
}

Json read_json(const Text& text) {
  try {
    return Json::parse(text.content);
  } catch (const Json::parse_error& error) {
    const auto end =
        text.content.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.content.size()));
    const auto breaks = std::count(text.content.begin(), end, '\n');
    text.fail(1 + static_cast<std::size_t>(breaks), "not valid JSON");
  } catch (const Json::out_of_range&) {
    text.fail(0, "a number is too large for a double");  // the parser does not report the position
  }
}

std::optional<Trajectory<SE3>> read_dense(const fs::path& folder, const std::string& robot) {
  const fs::path path = folder / "dense" / (robot + ".tum");
  if (!fs::exists(path)) return std::nullopt;
  return read_tum(read_text(path));
}

RunFolder read_run(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder.string(), 0, "no such run folder");
  RunFolder run;
  std::vector<std::string> ids;
  if (fs::exists(folder / "summary.json")) {
    const Text text = read_text(folder / "summary.json");
    run.summary = read_json(text);
    read_team_frame(text, run);
    ids = robots_in_summary(text, run.summary);
  } else {
    ids = robots_with_file(folder);
  }
  read_trajectories(folder, ids, run);
  read_candidates_of(folder, run);
  if (fs::exists(folder / "closures.csv"))
    run.closures = read_closures(read_text(folder / "closures.csv"), run.robots);
  if (fs::exists(folder / "aoa.csv"))
    run.aoa_measurements = read_measured_aoa(read_text(folder / "aoa.csv"), run.robots);
  if (fs::exists(folder / "access_points.csv"))
    run.access_points = read_access_points(read_text(folder / "access_points.csv"));
  if (fs::exists(folder / "uncertainty.csv"))
    read_uncertainty(read_text(folder / "uncertainty.csv"), run.robots);
  return run;
}

}  // namespace radioslam
