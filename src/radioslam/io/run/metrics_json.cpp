#include "radioslam/io/run/metrics_json.hpp"

#include "radioslam/io/run/run_tables.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::ordered_json;

Json ate_json(const std::optional<ErrorStatistics>& ate) {
  const auto value = [&](double ErrorStatistics::*member) { return ate ? Json((*ate).*member) : Json(); };
  return {{"ate_rmse_m", value(&ErrorStatistics::rmse_m)},
          {"ate_mean_m", value(&ErrorStatistics::mean_m)},
          {"ate_median_m", value(&ErrorStatistics::median_m)},
          {"ate_p90_m", value(&ErrorStatistics::p90_m)}};
}

Json number_or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

Json rpe_json(const std::optional<RelativeError>& rpe) {
  if (!rpe) return {};
  return {{"translation_rmse_m", rpe->translation_rmse_m},
          {"rotation_rmse_rad", rpe->rotation_rmse_rad},
          {"count", rpe->count}};
}

}  // namespace

Json metrics_json(const TeamMetrics& metrics) {
  Json json = ate_json(metrics.ate);
  json["rpe"] = rpe_json(metrics.rpe);
  json["rotation"] = nullptr;
  if (metrics.rotation_rmse_rad) json["rotation"] = {{"rmse_rad", *metrics.rotation_rmse_rad}};
  json["consistency"] = nullptr;
  if (metrics.consistency)
    json["consistency"] = {{"share_within_3_sigma", metrics.consistency->share_within_3_sigma}};
  if (metrics.team_consistency)
    json["consistency"]["team"] = {{"share_within_3_sigma", metrics.team_consistency->share_within_3_sigma},
                                   {"mean_square", metrics.team_consistency->mean_square}};
  json["coverage"] = metrics.coverage;
  json["robots"] = Json::object();
  for (const RobotMetrics& robot : metrics.robots) {
    Json& entry = json["robots"][robot.id] = ate_json(robot.ate);
    entry["coverage"] = robot.coverage;
  }
  return json;
}

Json pair_counts_json(const PairCounts& counts) {
  return {{"pairs", counts.pairs},
          {"true", counts.true_pairs},
          {"kept", counts.kept},
          {"true_kept", counts.true_kept}};
}

Json closures_by_kind_json(const ClosuresByKind& closures) {
  Json json = Json::object();
  for (const auto& [kind, counts] : closures) {
    Json& entry = json[std::string(closure_kind_name(kind))];
    entry = {{"accepted", counts.accepted},
             {"true_accepted", counts.true_accepted},
             {"rejected", counts.rejected},
             {"true_rejected", counts.true_rejected}};
    if (kind == ClosureKind::kMatch || kind == ClosureKind::kFile || kind == ClosureKind::kLidar) {
      entry["worst_accepted_m"] = number_or_null(counts.worst_accepted_m);
      entry["worst_accepted_rad"] = number_or_null(counts.worst_accepted_rad);
    }
    if (kind != ClosureKind::kAoa) continue;
    entry["direct_found"] = counts.direct_found;
    entry["wrong_path"] = counts.wrong_path;
    entry["none_direct"] = counts.none_direct;
  }
  return json;
}

Json access_point_errors_json(const AccessPointErrors& errors) {
  if (errors.known == 0) return nullptr;
  Json json = {{"known", errors.known}, {"located", errors.located}};
  const Json statistics = ate_json(errors.errors);
  for (const auto& [key, value] : statistics.items()) json[key.substr(4)] = value;  // without ate_
  return json;
}

}  // namespace radioslam
