#include "radioslam/study/study_json.hpp"

#include <algorithm>

#include "radioslam/io/run/metrics_json.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/study/wi_closure/published_wi_closure.hpp"
#include "radioslam/study/wi_closure_hall/hall_tables.hpp"
#include "radioslam/study/wi_closure_hall/published_hall.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::ordered_json;

Json optional_json(std::optional<double> value) { return value ? Json(*value) : Json(); }

Json search_json(const EvaluatedRun& run) {
  Json json = pair_counts_json(run.candidates);
  json["recall"] = optional_json(recall(run.candidates));
  json["false_rejected"] = optional_json(rejected_false(run.candidates));
  json["distances_evaluated"] = run.distances_evaluated;
  json["search_s"] = run.search_s;
  json["total_s"] = run.total_s;
  return json;
}

Json mode_json(const KittiMode& mode) {
  Json json = search_json(mode.search);
  json["ate_without_matches_m"] = optional_json(mode.search.ate_m);
  json["ate_pruned_m"] = optional_json(mode.aliased.ate_m);
  json["total_with_matches_s"] = mode.aliased.total_s;
  return json;
}

Json published_json() {
  using namespace published_wi_closure;
  return {{"pairs", kPairs},
          {"true", kTruePairs},
          {"kept", kKept},
          {"true_kept", kTrueKept},
          {"recall", kRecall},
          {"false_rejected", kFalseRejected},
          {"search_s", kSearch_s},
          {"total_s", kWithSearch_s},
          {"baseline_s", kBaseline_s},
          {"ate_unpruned_m", kBaselineAte_m}};
}

Json seed_json(const WiClosureKitti& seed) {
  return {{"seed", seed.seed},
          {"cut", seed.scenario.cut},
          {"links", seed.scenario.radio.links},
          {"joint", mode_json(seed.joint)},
          {"link", mode_json(seed.link)},
          {"ate_without_radio_m", optional_json(seed.without_radio.ate_m)},
          {"ate_least_squares_m", optional_json(seed.least_squares.ate_m)},
          {"ate_unpruned_m", optional_json(seed.unpruned.ate_m)},
          {"ate_true_matches_m", optional_json(seed.true_matches.ate_m)},
          {"ate_oracle_m", optional_json(seed.ate_oracle_m)}};
}

Json published_hall_json() {
  using namespace published_wi_closure_hall;
  return {{"pairs", kPairs},
          {"kept", kKept},
          {"true_kept", kTrueKept},
          {"recall", kRecall},
          {"false_rejected", kFalseRejected},
          {"search_s", kSearch_s},
          {"total_s", kWithSearch_s},
          {"baseline_s", kBaseline_s},
          {"ate_m", kAte_m},
          {"ate_baseline_m", kBaselineAte_m},
          {"angles", kAngles},
          {"direct_paths", kDirectPaths},
          {"false_paths", kFalsePaths}};
}

Json place_run_json(const PlaceRun& run) {
  return {{"place_pairs", run.places.pairs},
          {"place_pairs_allowed", run.places.allowed},
          {"descriptor_pairs", run.places.compared},
          {"registrations", run.places.registrations},
          {"registrations_verified", run.places.verified},
          {"closures_accepted", run.closures.accepted},
          {"closures_true_accepted", run.closures.true_accepted},
          {"in_one_frame", run.in_one_frame},
          {"ate_m", optional_json(run.ate_m)},
          {"scans_s", run.scans_s},
          {"overlap_s", run.overlap_s},
          {"places_s", run.places_s},
          {"total_s", run.total_s}};
}

const char* key_for(PlaceSettings settings) {
  switch (settings) {
    case PlaceSettings::kDefaults:
      return "defaults";
    case PlaceSettings::kDisco:
      return "disco";
    case PlaceSettings::kLoosenedDisco:
      return "loosened_disco";
  }
  return "";
}

Json place_study_json(const PlaceStudy& study) {
  Json json{{"seed", study.seed}, {"search", search_json(study.search)}};
  for (const PlaceRuns& runs : study.runs)
    json[key_for(runs.settings)] = {{"without_radio", place_run_json(runs.without_radio)},
                                    {"unpruned", place_run_json(runs.unpruned)},
                                    {"pruned", place_run_json(runs.pruned)}};
  json["angles"] = Json::array();
  for (const AnglePaths& angle : study.angles)
    json["angles"].push_back({{"paths", angle.paths},
                              {"direct_path", angle.direct_path ? Json(*angle.direct_path) : Json()},
                              {"path_weights", angle.weights},
                              {"accepted", angle.accepted}});
  return json;
}

Json budget_run_json(const BudgetRun& run) {
  return {{"order", word_for(run.order)},
          {"share", run.share},
          {"registrations", run.registrations},
          {"verified", run.verified},
          {"ate_m", optional_json(run.ate_m)}};
}

Json table1_seed_json(const WiClosureTable1& seed) {
  Json json = place_study_json(seed.places);
  json["cut"] = seed.scenario.cut;
  json["links"] = seed.scenario.radio.links;
  return json;
}

Json cell_json(const RobustnessCell& cell) {
  const RobustnessSummary s = summarise(cell);
  return {{"sigma_angle_deg", cell.sigma_angle_deg},
          {"links", cell.links},
          {"false_paths", cell.false_paths},
          {"ratio", optional_json(s.ratio)},
          {"worst_ratio", optional_json(s.worst_ratio)},
          {"ate_m", optional_json(s.ate_m)},
          {"ate_oracle_m", optional_json(s.ate_oracle_m)},
          {"recall", optional_json(s.recall)},
          {"least_recall", optional_json(s.min_recall)},
          {"false_rejected", optional_json(s.rejected_false)},
          {"failed", s.failed},
          {"confidently_wrong", s.confidently_wrong}};
}

Json growth_mode_json(const std::vector<OverlapGrowthPoint>& points) {
  Json towns = Json::array();
  for (const OverlapGrowthPoint& p : points)
    towns.push_back({{"poses", p.poses},
                     {"pairs", p.pairs},
                     {"kept", p.kept},
                     {"distances_evaluated", p.distances_evaluated},
                     {"prepare_s", p.prepare_s},
                     {"search_s", p.search_s},
                     {"all_pairs_s", optional_json(p.all_pairs_s)}});
  return {{"exponent", optional_json(growth_exponent(points))}, {"towns", std::move(towns)}};
}

Json figures_json(const AoaFigures& figures) {
  return {{"links", figures.links},
          {"median_error_rad", optional_json(figures.median_rad)},
          {"within_10_deg", optional_json(figures.within_10_deg)},
          {"best_of_4_within_10_deg", optional_json(figures.best_of_4_within_10_deg)},
          {"within_1_645_sigma", optional_json(figures.within_sigma)},
          {"own_frame_median_error_rad", optional_json(figures.own_frame_median_rad)}};
}

Json link_json(const AoaLink& link) {
  Json peaks = Json::array();
  for (const AoaPeak& peak : link.peaks)
    peaks.push_back({{"azimuth_rad", peak.azimuth_rad},
                     {"elevation_rad", peak.elevation_rad},
                     {"sigma_rad", peak.sigma_rad},
                     {"power_db", peak.power_db},
                     {"ghost", peak.is_cross_term}});
  const bool measured = !link.peaks.empty();
  return {{"trial", link.trial},
          {"transmitter", link.transmitter},
          {"sight", word_for(link.sight)},
          {"motion", word_for(link.motion)},
          {"true_azimuth_rad", link.true_azimuth_rad},
          {"error_rad", measured ? Json(error_rad(link)) : Json()},
          {"own_frame_error_rad", measured ? Json(own_frame_error_rad(link)) : Json()},
          {"peaks", std::move(peaks)},
          {"authors_errors_rad", link.published_rad},
          {"reason", link.reason}};
}

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
  Json json;
  if (mission.seed)
    json["seed"] = *mission.seed;
  else
    json["mission"] = mission.name;
  if (!mission.measure.empty()) json["measure"] = mission.measure;
  json["dead_reckoning_ate_m"] = null_or(mission.dead_reckoning_ate_m);
  json["default_ate_m"] = null_or(mission.default_ate_m);
  json["best"] = best ? threshold_json(*best) : Json();
  json["default_over_best"] = null_or(mission.default_over_best());
  json["default_over_dead_reckoning"] = null_or(mission.default_over_dead_reckoning());
  json["cells"] = Json::array();
  for (const ThresholdCell& cell : mission.cells) json["cells"].push_back(threshold_json(cell));
  return json;
}

/// Every round up to a hundred, then one in each 2 %, and the last one.
Json trace_json(const DistributedRun& run) {
  constexpr std::size_t kPart = 50;
  Json trace = Json::array();
  const std::size_t rounds = run.bytes.size();
  for (std::size_t round = 1; round <= rounds;) {
    if (const auto gap = run.outcome.gaps[round - 1])
      trace.push_back({round, run.bytes[round - 1], rounded_relative(*gap)});
    const std::size_t next = round + std::max<std::size_t>(1, round / kPart);
    round = round < rounds ? std::min(next, rounds) : next;
  }
  return trace;
}

Json count_json(std::optional<std::size_t> value) { return value ? Json(*value) : Json(); }

Json distributed_run_json(const DistributedRun& run) {
  const TeamOutcome& outcome = run.outcome;
  return {{"method", run.method},
          {"settled", run.settled},
          {"rounds", run.bytes.size()},
          {"bytes", outcome.traffic.bytes()},
          {"relative_gap", outcome.relative_gap()},
          {"central_cost", outcome.central_cost},
          {"rounds_to_optimum", count_json(outcome.rounds_to_optimum)},
          {"bytes_to_optimum", count_json(outcome.bytes_to_optimum)},
          {"trace", trace_json(run)}};
}

}  // namespace

Json wi_closure_kitti_json(const std::vector<WiClosureKitti>& seeds) {
  Json json{{"table", "wi-closure-kitti"}, {"published", published_json()}, {"seeds", Json::array()}};
  for (const auto& seed : seeds) json["seeds"].push_back(seed_json(seed));
  return json;
}

Json wi_closure_table1_json(const std::vector<WiClosureTable1>& seeds) {
  Json json{{"table", "wi-closure-table1"}, {"published", published_json()}, {"seeds", Json::array()}};
  for (const WiClosureTable1& seed : seeds) json["seeds"].push_back(table1_seed_json(seed));
  return json;
}

Json wi_closure_hall_json(const std::vector<WiClosureHall>& halls) {
  const AngleCounts angles = count_angles(halls);
  Json json{{"table", "wi-closure-hall"},
            {"published", published_hall_json()},
            {"angles",
             {{"measurements", angles.angles},
              {"with_direct", angles.with_direct},
              {"direct_found", angles.direct_found},
              {"paths", angles.paths}}},
            {"seeds", Json::array()}};
  for (const WiClosureHall& hall : halls) json["seeds"].push_back(place_study_json(hall.places));
  return json;
}

Json robustness_json(const RobustnessMap& map) {
  Json json{{"table", "robustness-map"},
            {"axes",
             {{"sigma_angle_deg", map.grid.sigma_angle_deg},
              {"links", map.grid.links},
              {"false_paths", map.grid.false_paths}}},
            {"first_seed", map.first_seed},
            {"seeds", map.seeds},
            {"cells", Json::array()}};
  for (const auto& cell : map.cells) json["cells"].push_back(cell_json(cell));
  return json;
}

nlohmann::ordered_json verification_budget_json(const std::vector<BudgetMission>& missions) {
  Json json{{"table", "verification-budget"}, {"medians", Json::array()}, {"missions", Json::array()}};
  for (const BudgetMedian& m : budget_medians(missions))
    json["medians"].push_back({{"scenario", m.scenario},
                               {"order", word_for(m.order)},
                               {"share", m.share},
                               {"registrations", optional_json(m.registrations)},
                               {"verified", optional_json(m.verified)},
                               {"ate_m", optional_json(m.ate_m)},
                               {"ratio", optional_json(m.ratio)}});
  for (const BudgetMission& m : missions) {
    Json runs = Json::array();
    for (const BudgetRun& run : m.runs) runs.push_back(budget_run_json(run));
    json["missions"].push_back({{"scenario", m.scenario},
                                {"seed", m.seed},
                                {"descriptor_bytes", m.descriptor_bytes},
                                {"descriptor_bytes_all", m.descriptor_bytes_all},
                                {"all", budget_run_json(m.all)},
                                {"runs", std::move(runs)}});
  }
  return json;
}

nlohmann::ordered_json distributed_optimization_json(const std::vector<DistributedTeam>& teams) {
  Json json{{"table", "distributed-optimization"}, {"teams", Json::array()}};
  for (const DistributedTeam& team : teams) {
    Json runs = Json::array();
    for (const DistributedRun& run : team.runs) runs.push_back(distributed_run_json(run));
    json["teams"].push_back({{"name", team.name},
                             {"robots", team.robots},
                             {"poses", team.poses},
                             {"factors", team.factors},
                             {"factors_between", team.factors_between},
                             {"bytes_of_all_graphs", team.bytes_of_all_graphs},
                             {"runs", std::move(runs)}});
  }
  return json;
}

nlohmann::ordered_json team_json(const TeamStudy& study) {
  Json json{{"table", "team"},
            {"first_seed", study.first_seed},
            {"descriptor_bytes", study.descriptor_bytes},
            {"cases", Json::array()}};
  for (std::size_t k = 0; k < study.cases.size(); ++k) {
    const TeamCase& of = study.cases[k];
    Json seeds = Json::array();
    for (const TeamSample& s : study.samples[k])
      seeds.push_back({{"run_ate_m", optional_json(s.run_ate_m)},
                       {"agent_ate_m", optional_json(s.agent_ate_m)},
                       {"way_ate_m", optional_json(s.way_ate_m)},
                       {"way_share", s.way_share},
                       {"all_know_all", s.all_know_all},
                       {"settled_s", s.settled_s},
                       {"messages", s.messages},
                       {"lost", s.lost},
                       {"bytes", s.bytes},
                       {"bytes_at_one", s.bytes_at_one},
                       {"bytes_to_all", s.bytes_to_all},
                       {"bytes_of_descriptors", s.bytes_of_descriptors},
                       {"bytes_boxes_first", s.bytes_boxes_first}});
    json["cases"].push_back({{"robots", of.robots},
                             {"path_m", of.path_m},
                             {"loss", of.loss},
                             {"partition_s", of.partition_s},
                             {"seeds", std::move(seeds)}});
  }
  return json;
}

nlohmann::ordered_json overlap_growth_json(const OverlapGrowth& growth) {
  return {{"table", "overlap-growth"},
          {"seed", growth.seed},
          {"joint", growth_mode_json(growth.joint)},
          {"link", growth_mode_json(growth.link)}};
}

nlohmann::ordered_json aoa_json(const std::vector<AoaLink>& links, const std::vector<WsrResult>& published) {
  Json json{{"table", "aoa"}, {"groups", Json::array()}, {"links", Json::array()}};
  for (const AoaGroup& group : group_links(links, published))
    json["groups"].push_back({{"sight", word_for(group.sight)},
                              {"motion", word_for(group.motion)},
                              {"ours", figures_json(group.estimated)},
                              {"authors_same_trials", figures_json(group.published)},
                              {"authors_all", figures_json(group.published_all)}});
  for (const AoaLink& link : links) json["links"].push_back(link_json(link));
  return json;
}

nlohmann::ordered_json aoa_paths_json(const std::vector<AoaPathsCell>& cells) {
  Json json{{"table", "aoa-paths"}, {"cells", Json::array()}};
  for (const AoaPathsCell& cell : cells) {
    Json runs = Json::array();
    for (const AoaPathsRun& run : cell.runs)
      runs.push_back({{"seed", run.seed},
                      {"measured", run.measured},
                      {"found", run.found},
                      {"direct_error_rad", run.direct_error_rad},
                      {"strongest_error_rad", run.strongest_error_rad},
                      {"ghosts", run.cross_terms}});
    json["cells"].push_back(
        {{"profile", cell.profile}, {"cards", word_for(cell.cards)}, {"runs", std::move(runs)}});
  }
  return json;
}

nlohmann::ordered_json sequence_json(const std::vector<SequenceCell>& cells) {
  Json json{{"table", "sequence-closures"}, {"cells", Json::array()}};
  for (const SequenceCell& cell : cells) {
    Json accepted = Json::array();
    for (const SequenceError& error : cell.accepted)
      accepted.push_back({{"error_m", error.distance_m},
                          {"error_rad", null_or(error.angle_rad)},
                          {"nees", null_or(error.nees)},
                          {"right", error.right()}});
    json["cells"].push_back({{"least_similarity", cell.min_similarity},
                             {"window_way_m", cell.window_path_m},
                             {"missions", cell.missions},
                             {"candidates", cell.candidates},
                             {"accepted", std::move(accepted)}});
    if (!cell.measure.empty()) json["cells"].back()["measure"] = cell.measure;
    if (cell.without_truth > 0) json["cells"].back()["without_truth"] = cell.without_truth;
  }
  return json;
}

nlohmann::ordered_json fingerprint_tables_json(const FingerprintTables& tables) {
  Json json{{"table", "fingerprint-tables"}};
  if (!tables.missions.empty() && tables.missions.front().seed)
    json["first_seed"] = *tables.missions.front().seed;
  else
    for (const StudyMission& mission : tables.missions) json["missions"].push_back(mission.name());
  json["defaults_ate_m"] = list_json(tables.defaults_ate_m);
  json["dead_reckoning_ate_m"] = list_json(tables.dead_reckoning_ate_m);
  json["cells"] = Json::array();
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
