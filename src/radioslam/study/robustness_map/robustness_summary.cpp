#include "radioslam/study/robustness_map/robustness_summary.hpp"

#include <algorithm>

namespace radioslam {
namespace {

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
