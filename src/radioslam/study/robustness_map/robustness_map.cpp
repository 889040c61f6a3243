#include "radioslam/study/robustness_map/robustness_map.hpp"

#include <algorithm>

#include "radioslam/base/parallel.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/oracle.hpp"
#include "radioslam/study/progress_counter.hpp"

namespace radioslam {
namespace {

bool is_wrong(std::optional<double> ate_m, std::optional<double> oracle_m) {
  if (!oracle_m) return false;
  if (!ate_m) return true;
  return *ate_m > kFailedRatio * *oracle_m && *ate_m > *oracle_m + kFailedExcess_m;
}

CityParams town_of(const CityParams& town, const RobustnessCell& cell) {
  CityParams params = town;
  params.radio.sigma_angle_deg = cell.sigma_angle_deg;
  params.radio.links = cell.links;
  params.radio.min_false_paths = params.radio.max_false_paths = cell.false_paths;
  return params;
}

RobustnessSample sample(const CityParams& town, std::uint64_t seed) {
  const auto [mission, truth] = simulate_city(town, seed);
  RunOptions search;
  search.overlap_only = true;
  const EvaluatedRun run = run_and_evaluate(mission, truth, {}, search);
  RobustnessSample result;
  result.ate_m = run.ate_m;
  result.best_ate_m = run.best_ate_m;
  result.weight = run.weight;
  result.recall = recall(run.candidates);
  result.rejected_false = rejected_false(run.candidates);
  if (const auto oracle = oracle_estimate(mission, truth, {}, run.estimate))
    result.ate_oracle_m = ate_rmse_m(*oracle, truth, mission.dimension);
  return result;
}

std::vector<RobustnessCell> empty_cells(const RobustnessGrid& grid, std::size_t seeds) {
  std::vector<RobustnessCell> cells;
  for (const int paths : grid.false_paths)
    for (const int links : grid.links)
      for (const double sigma : grid.sigma_angle_deg)
        cells.push_back({sigma, links, paths, std::vector<RobustnessSample>(seeds)});
  return cells;
}

template <class Value>
std::vector<double> known_values(const RobustnessCell& cell, Value&& value) {
  std::vector<double> values;
  for (const RobustnessSample& sample : cell.samples)
    if (const std::optional<double> v = value(sample)) values.push_back(*v);
  return values;
}

template <class Question>
double ratio(const RobustnessCell& cell, Question&& question) {
  if (cell.samples.empty()) return 0;
  const auto count = std::count_if(cell.samples.begin(), cell.samples.end(), question);
  return static_cast<double>(count) / static_cast<double>(cell.samples.size());
}

std::optional<double> largest(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return *std::max_element(values.begin(), values.end());
}

std::optional<double> least(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return *std::min_element(values.begin(), values.end());
}

}  // namespace

std::optional<double> RobustnessSample::ratio() const {
  if (!ate_m || !ate_oracle_m || *ate_oracle_m <= 0) return std::nullopt;
  return *ate_m / *ate_oracle_m;
}

bool RobustnessSample::failed() const { return is_wrong(ate_m, ate_oracle_m); }

bool RobustnessSample::confidently_wrong() const {
  return failed() && weight >= kConfidentWeight && is_wrong(best_ate_m, ate_oracle_m);
}

RobustnessMap map_robustness(const RobustnessGrid& grid, const CityParams& town, std::uint64_t first_seed,
                             int seeds, const Progress& progress) {
  const auto per_cell = static_cast<std::size_t>(seeds);
  RobustnessMap map{grid, first_seed, seeds, empty_cells(grid, per_cell)};
  ProgressCounter counter(progress, "towns", map.cells.size() * per_cell);
  parallel_for(map.cells.size() * per_cell, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      RobustnessCell& cell = map.cells[k / per_cell];
      cell.samples[k % per_cell] = sample(town_of(town, cell), first_seed + k % per_cell);
      counter.one_more();
    }
  });
  return map;
}

RobustnessSummary summarise(const RobustnessCell& cell) {
  const auto ratios = known_values(cell, [](const auto& s) { return s.ratio(); });
  const auto recalls = known_values(cell, [](const auto& s) { return s.recall; });
  RobustnessSummary summary;
  summary.ratio = median_of(ratios);
  summary.worst_ratio = largest(ratios);
  summary.ate_m = median_of(known_values(cell, [](const auto& s) { return s.ate_m; }));
  summary.ate_oracle_m = median_of(known_values(cell, [](const auto& s) { return s.ate_oracle_m; }));
  summary.recall = median_of(recalls);
  summary.min_recall = least(recalls);
  summary.rejected_false = median_of(known_values(cell, [](const auto& s) { return s.rejected_false; }));
  summary.failed = ratio(cell, [](const auto& s) { return s.failed(); });
  summary.confidently_wrong = ratio(cell, [](const auto& s) { return s.confidently_wrong(); });
  return summary;
}

StudyTable robustness_table(const RobustnessMap& map) {
  StudyTable table{
      "Robustness map",
      "Towns with two robots, angles at both ends; median over " + std::to_string(map.seeds) +
          " seeds from " + std::to_string(map.first_seed) + " on.",
      {"links", "noise, deg", "ATE / oracle", "worst", "ATE, m", "oracle, m", "recall", "least",
       "false rejected", "failed", "confidently wrong"},
      {},
      {"A run has failed if its error exceeds both twice the oracle's and the oracle's plus 1 m; it was "
       "confidently wrong if it failed with a weight of 0.9 or more and without a right alternative."}};
  for (const RobustnessCell& cell : map.cells) {
    const RobustnessSummary s = summarise(cell);
    table.rows.push_back(
        {std::to_string(cell.false_paths) + " false paths",
         {std::to_string(cell.links), number_text(cell.sigma_angle_deg, 0), number_text(s.ratio, 2),
          number_text(s.worst_ratio, 2), number_text(s.ate_m, 2), number_text(s.ate_oracle_m, 2),
          number_text(s.recall, 4), number_text(s.min_recall, 4), number_text(s.rejected_false, 4),
          number_text(s.failed, 2), number_text(s.confidently_wrong, 2)}});
  }
  return table;
}

}  // namespace radioslam
