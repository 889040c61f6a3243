#include "radioslam/study/verification_budget/budget_study.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/eval/team_estimate.hpp"
#include "radioslam/sim/scenarios/city.hpp"
#include "radioslam/sim/scenarios/hall.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"

namespace radioslam {
namespace {

using Order = VerificationBudget::Order;
constexpr Order kOrders[] = {Order::kWorth, Order::kSimilarity, Order::kRandom};

double count_of(const RunResult& result, const char* key) {
  const auto found = result.counts.find(key);
  return found == result.counts.end() ? 0 : found->second;
}

BudgetRun budget_run(const RunResult& result, const Truth& truth, Order order, double share) {
  BudgetRun run{
      order, share, count_of(result, "registrations"), count_of(result, "registrations_verified"), {}};
  if (result.components.size() == 1 && result.unplaced.empty())
    run.ate_m = ate_rmse_m(team_estimate(result), truth, result.dimension);
  return run;
}

/// Three robots that scan the streets they drive through.
CityParams scanned_streets() {
  CityParams streets;
  streets.robots = 3;
  streets.path_length_m = 500;
  streets.onboard.lidar.lidar_beams = 16;
  streets.matches.matches_true = streets.matches.matches_false = 0;
  return streets;
}

/// The run of one order and share of each mission of a scenario.
using Cell = std::vector<std::pair<const BudgetMission*, const BudgetRun*>>;

BudgetMedian median_of_cell(const Cell& cell) {
  const auto& [mission, first] = cell.front();
  const auto median = [&](const auto& value) { return median_over(cell, value); };
  return {mission->scenario,
          first->order,
          first->share,
          median([](const auto& c) { return std::optional(c.second->registrations); }),
          median([](const auto& c) { return std::optional(c.second->verified); }),
          median([](const auto& c) { return c.second->ate_m; }),
          median([](const auto& c) -> std::optional<double> {
            if (!c.second->ate_m || !c.first->all.ate_m) return std::nullopt;
            return *c.second->ate_m / *c.first->all.ate_m;
          })};
}

}  // namespace

BudgetMission study_budget(const std::string& scenario, const Simulation& simulation, std::uint64_t seed,
                           const Progress& progress) {
  constexpr double kRuns = static_cast<double>(std::size(kOrders) * std::size(kBudgetShares));
  const auto& [mission, truth] = simulation;
  RunParams params;
  params.places.least_worth = 0;  // without a budget all that are proposed
  StageClock timed;
  const MeasuredRecordings recordings = measure_recordings(mission, params, {}, timed, progress);
  const RunResult all = run_pipeline(mission, recordings, params).result;
  BudgetMission study{scenario,
                      seed,
                      count_of(all, "descriptor_bytes"),
                      count_of(all, "descriptor_bytes_all"),
                      budget_run(all, truth, Order::kWorth, 1),
                      {}};
  for (const Order order : kOrders)
    for (const double share : kBudgetShares) {
      report_progress(progress, scenario, static_cast<double>(study.runs.size()) / kRuns);
      RunOptions options;
      options.verifications =
          VerificationBudget{static_cast<std::size_t>(std::floor(share * study.all.registrations)), order};
      study.runs.push_back(
          budget_run(run_pipeline(mission, recordings, params, options).result, truth, order, share));
    }
  report_progress(progress, scenario, 1);
  return study;
}

std::vector<BudgetMission> study_budgets(std::uint64_t seed, const Progress& progress) {
  return {study_budget("hall", simulate_hall(scanned_hall(), seed), seed, progress),
          study_budget("streets", simulate_city(scanned_streets(), seed), seed, progress)};
}

const char* word_for(VerificationBudget::Order order) {
  switch (order) {
    case Order::kWorth:
      return "worth";
    case Order::kSimilarity:
      return "similarity";
    case Order::kRandom:
      return "random";
  }
  return "";
}

std::vector<BudgetMedian> budget_medians(const std::vector<BudgetMission>& missions) {
  std::vector<BudgetMedian> medians;
  std::vector<std::string> scenarios;
  for (const BudgetMission& mission : missions)
    if (std::find(scenarios.begin(), scenarios.end(), mission.scenario) == scenarios.end())
      scenarios.push_back(mission.scenario);
  for (const std::string& scenario : scenarios)
    for (std::size_t k = 0; k < missions.front().runs.size(); ++k) {
      Cell cell;
      for (const BudgetMission& mission : missions)
        if (mission.scenario == scenario) cell.emplace_back(&mission, &mission.runs[k]);
      medians.push_back(median_of_cell(cell));
    }
  return medians;
}

StudyTable budget_table(const std::vector<BudgetMission>& missions) {
  const std::size_t seeds =
      static_cast<std::size_t>(std::count_if(missions.begin(), missions.end(), [&](const BudgetMission& m) {
        return m.scenario == missions.front().scenario;
      }));
  StudyTable table{
      "Error over the number of verifications",
      "Scans of different robots are registered within a budget (run --max-verifications): by "
      "worth, as run does, by the similarity of descriptors, and at random. " +
          seeds_text(missions.front().seed, seeds) + ".",
      {"registrations", "verified", "ATE, m", "ATE / that with all"},
      {},
      {"Two robots in a hall of identical pillars; three in streets, 500 m each; scans of 16 beams, "
       "no listed matches. 100 %: as many registrations as without a bound, but half of them are "
       "kept for the second round."}};
  for (const BudgetMedian& m : budget_medians(missions))
    table.rows.push_back({m.scenario + ", " + word_for(m.order) + ", " + percent_text(m.share, 0),
                          {number_text(m.registrations, 0), number_text(m.verified, 0),
                           number_text(m.ate_m, 3), number_text(m.ratio, 2)}});
  for (const BudgetMission& m : missions)
    table.notes.push_back(m.scenario + ", seed " + std::to_string(m.seed) + ": " +
                          number_text(m.all.ate_m, 3) + " m with all " + number_text(m.all.registrations, 0) +
                          " registrations; descriptors of keyframes that may overlap " +
                          number_text(m.descriptor_bytes, 0) + " bytes, all " +
                          number_text(m.descriptor_bytes_all, 0) + ".");
  return table;
}

}  // namespace radioslam
