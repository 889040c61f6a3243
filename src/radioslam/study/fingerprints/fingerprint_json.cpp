#include "radioslam/study/study_json.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::ordered_json;

Json null_or(std::optional<double> value) { return value ? Json(*value) : Json(); }

Json list_json(const std::vector<std::optional<double>>& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back(null_or(value));
  return list;
}

Json threshold_json(const ThresholdCell& cell) {
  return {{"nu_m", cell.nu_m}, {"loss_sigmas", null_or(cell.loss_sigmas)}, {"ate_m", null_or(cell.ate_m)}};
}

Json swept_json(const SweptMission& mission) {
  const ThresholdCell* best = mission.best();
  Json json{{"seed", mission.seed},
            {"dead_reckoning_ate_m", null_or(mission.dead_reckoning_ate_m)},
            {"default_ate_m", null_or(mission.default_ate_m)},
            {"best", best ? threshold_json(*best) : Json()},
            {"default_over_best", null_or(mission.default_over_best())},
            {"default_over_dead_reckoning", null_or(mission.default_over_dead_reckoning())},
            {"cells", Json::array()}};
  for (const ThresholdCell& cell : mission.cells) json["cells"].push_back(threshold_json(cell));
  return json;
}

}  // namespace

nlohmann::ordered_json fingerprint_tables_json(const FingerprintTables& tables) {
  Json json{{"table", "fingerprint-tables"},
            {"first_seed", tables.first_seed},
            {"defaults_ate_m", list_json(tables.defaults_ate_m)},
            {"dead_reckoning_ate_m", list_json(tables.dead_reckoning_ate_m)},
            {"cells", Json::array()}};
  for (const FingerprintCell& cell : tables.cells)
    json["cells"].push_back(
        {{"measure", kFingerprintMeasures[cell.measure].measure},
         {"sigma_detection", kFingerprintMeasures[cell.measure].sigma_detection},
         {"nu_s_m", cell.nu_within_m},
         {"nu_p_m", cell.nu_between_m},
         {"published_m", {null_or(published_ate_m(0, cell)), null_or(published_ate_m(1, cell))}},
         {"ate_m", list_json(cell.ate_m)}});
  return json;
}

nlohmann::ordered_json threshold_sweep_json(const std::vector<SweptMission>& missions) {
  Json json{{"table", "threshold-sweep"}, {"missions", Json::array()}};
  for (const SweptMission& mission : missions) json["missions"].push_back(swept_json(mission));
  return json;
}

}  // namespace radioslam
