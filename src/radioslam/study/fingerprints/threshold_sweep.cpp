#include "radioslam/study/fingerprints/threshold_sweep.hpp"

#include <algorithm>
#include <functional>

#include "radioslam/base/parallel.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/progress_counter.hpp"

namespace radioslam {
namespace {

constexpr double kLeastSquares_sigmas = 1e6;  // a Cauchy loss this wide is quadratic
constexpr int kMetreDecimals = 2, kShareDecimals = 3, kScaleDecimals = 1;

RunParams params_of(const std::string& measure) {
  RunParams params;
  if (!measure.empty()) params.radio.measure = measure;
  params.access_points.enabled = false;  // they come after the estimate
  return params;
}

RunParams params_of(const ThresholdCell& cell, const std::string& measure) {
  RunParams params = params_of(measure);
  params.closure.within_distance_m = params.closure.between_distance_m = cell.nu_m;
  params.closure.nearest_factor = 0;
  params.robust.final_scale = cell.loss_sigmas.value_or(kLeastSquares_sigmas);
  params.robust.first_scale = std::max(params.robust.first_scale, params.robust.final_scale);
  return params;
}

SweptMission empty_mission(const ThresholdGrid& grid, const StudyMission& of, const std::string& measure) {
  SweptMission mission{of.name(), {}, {}, {}, of.seed, measure};
  for (const double nu_m : grid.nu_m)
    for (const auto loss_sigmas : grid.loss_sigmas) mission.cells.push_back({nu_m, loss_sigmas});
  return mission;
}

void sweep(SweptMission& swept, const Mission& mission, const Truth& truth, ProgressCounter& counter) {
  swept.dead_reckoning_ate_m = dead_reckoning_ate_m(mission, truth);
  swept.default_ate_m = run_and_evaluate(mission, truth, params_of(swept.measure), {}).ate_m;
  parallel_for(swept.cells.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      swept.cells[k].ate_m =
          run_and_evaluate(mission, truth, params_of(swept.cells[k], swept.measure), {}).ate_m;
      counter.one_more();
    }
  });
}

std::optional<double> quotient(std::optional<double> part, std::optional<double> whole) {
  if (!part || !whole || *whole <= 0) return std::nullopt;
  return *part / *whole;
}

StudyRow sweep_row(const SweptMission& mission) {
  const ThresholdCell* best = mission.best();
  return {"mission " + mission.name + (mission.measure.empty() ? "" : ", " + mission.measure),
          {number_text(mission.dead_reckoning_ate_m, kMetreDecimals),
           number_text(mission.default_ate_m, kMetreDecimals),
           number_text(best ? best->ate_m : std::nullopt, kMetreDecimals), best ? label_of(*best) : "–",
           number_text(mission.default_over_best(), kShareDecimals),
           number_text(mission.default_over_dead_reckoning(), kShareDecimals)}};
}

using Summary = std::function<std::optional<double>(std::vector<double>)>;

StudyRow summary_row(const char* label, const std::vector<SweptMission>& missions, const Summary& summary) {
  std::vector<double> over_best, over_dead_reckoning;
  for (const SweptMission& mission : missions) {
    if (const auto ratio = mission.default_over_best()) over_best.push_back(*ratio);
    if (const auto ratio = mission.default_over_dead_reckoning()) over_dead_reckoning.push_back(*ratio);
  }
  return {label,
          {"", "", "", "", number_text(summary(over_best), kShareDecimals),
           number_text(summary(over_dead_reckoning), kShareDecimals)}};
}

std::optional<double> largest_of(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return *std::max_element(values.begin(), values.end());
}

}  // namespace

const ThresholdCell* SweptMission::best() const {
  const ThresholdCell* best = nullptr;
  for (const ThresholdCell& cell : cells)
    if (cell.ate_m && (!best || *cell.ate_m < *best->ate_m)) best = &cell;
  return best;
}

std::optional<double> SweptMission::default_over_best() const {
  const ThresholdCell* cell = best();
  return cell ? quotient(default_ate_m, cell->ate_m) : std::nullopt;
}

std::optional<double> SweptMission::default_over_dead_reckoning() const {
  return quotient(default_ate_m, dead_reckoning_ate_m);
}

std::string label_of(const ThresholdCell& cell) {
  const std::string loss =
      cell.loss_sigmas ? "Cauchy " + number_text(cell.loss_sigmas, kScaleDecimals) + " σ" : "least squares";
  return "ν " + number_text(cell.nu_m, 0) + " m, " + loss;
}

std::vector<SweptMission> sweep_thresholds(const std::vector<StudyMission>& missions,
                                           const ThresholdGrid& grid,
                                           const std::vector<std::string>& measures,
                                           const Progress& progress) {
  std::vector<SweptMission> swept;
  ProgressCounter counter(progress, "cells",
                          grid.nu_m.size() * grid.loss_sigmas.size() * missions.size() * measures.size());
  for (const StudyMission& of : missions)
    for (const std::string& measure : measures) {
      swept.push_back(empty_mission(grid, of, measure));
      sweep(swept.back(), of.mission, of.truth, counter);
    }
  return swept;
}

StudyTable threshold_sweep_table(const std::vector<SweptMission>& missions) {
  StudyTable table{
      "A threshold and a loss tuned by hand",
      ("Missions estimated with the defaults, and over a grid of nu and of the closures' loss whose best "
       "cell is chosen by the truth. Position errors: RMSE after one alignment of the team."),
      {"dead reckoning, m", "defaults, m", "best cell, m", "best cell", "defaults / best",
       "defaults / dead reckoning"},
      {},
      {"nu is the largest predicted distance of a pair, within a robot and between robots.",
       "Everything else, including the closures' weights, has its default value in every cell."}};
  if (std::any_of(missions.begin(), missions.end(),
                  [](const SweptMission& mission) { return !mission.dead_reckoning_ate_m; }))
    table.notes.push_back("Dead reckoning needs the robots' starts (initial_pose).");
  for (const SweptMission& mission : missions) table.rows.push_back(sweep_row(mission));
  table.rows.push_back(summary_row("median", missions, median_of));
  table.rows.push_back(summary_row("worst", missions, largest_of));
  return table;
}

}  // namespace radioslam
