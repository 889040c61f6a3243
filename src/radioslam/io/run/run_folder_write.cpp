#include <cmath>
#include <cstdint>

#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/run/run_folder.hpp"
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
  const Json summary = summary_json(result, documents.metrics);
  write_file(folder / "summary.json",
             summary.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace radioslam
