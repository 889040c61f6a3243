#include "radioslam/study/fingerprints/fingerprint_tables.hpp"

namespace radioslam {
namespace {

constexpr int kErrorDecimals = 2, kRatioDecimals = 3;

std::string label_of(const FingerprintCell& cell) {
  const std::string measure = kFingerprintMeasures[cell.measure].label;
  const std::string nu_within = "ν_s " + number_text(cell.nu_within_m, 0);
  if (cell.nu_between_m == 0) return "I: " + measure + ", " + nu_within;
  return "II, III: " + nu_within + ", " + measure + ", ν_p " + number_text(cell.nu_between_m, 0);
}

std::optional<double> over(std::optional<double> part, std::optional<double> whole) {
  if (!part || !whole || *whole <= 0) return std::nullopt;
  return *part / *whole;
}

StudyRow row_of(std::string label, std::optional<double> first_m, std::optional<double> second_m,
                std::optional<double> ours_m, const FingerprintTables& tables) {
  return {std::move(label),
          {number_text(first_m, kErrorDecimals), number_text(second_m, kErrorDecimals),
           number_text(ours_m, kErrorDecimals),
           number_text(over(ours_m, mean_of(tables.dead_reckoning_ate_m)), kRatioDecimals)}};
}

std::string lead_of(const FingerprintTables& tables) {
  const std::size_t missions = tables.defaults_ate_m.size();
  const std::string seeds =
      missions == 1 ? "Seed " + std::to_string(tables.first_seed)
                    : std::to_string(missions) + " seeds from " + std::to_string(tables.first_seed) + " on";
  return seeds +
         ": the published algorithm in simulated car parks, over its thresholds in metres. Position " +
         "errors in metres, RMSE after one alignment of the team, means over the seeds.";
}

std::vector<std::string> fingerprint_notes() {
  return {
      "I: single robots (nu_p = 0); II, III: the team. Table II of the paper is Test I, III is Test II.",
      ("The published drives and odometry differ from the simulated ones: compare how the error falls and "
       "rises again with nu, not the metres."),
      ("As published: windows of 5 s, every pair with its full weight 1 / sigma(s)^2, least squares, no "
       "variable for the odometry's constant drift. Chosen here, as not published: odometry's white noise "
       "as the mission states it, 30 samples at least in a window over similarity, sigma of at least 1 m."),
      "The defaults are those of `radioslam run`, the same for every mission."};
}

}  // namespace

std::optional<double> mean_of(const std::vector<std::optional<double>>& values) {
  double sum = 0, count = 0;
  for (const auto& value : values)
    if (value) sum += *value, ++count;
  if (count == 0) return std::nullopt;
  return sum / count;
}

StudyTable fingerprint_tables_table(const FingerprintTables& tables) {
  const auto published = [](std::size_t test) { return published_ate_m(test, {0, 0, 0}); };
  StudyTable table{"Collaborative radio SLAM by fingerprints",
                   lead_of(tables),
                   {"Test I, published", "Test II, published", "ours", "ours / dead reckoning"},
                   {},
                   fingerprint_notes()};
  table.rows.push_back(row_of("without ν: the defaults", {}, {}, mean_of(tables.defaults_ate_m), tables));
  table.rows.push_back(
      row_of("dead reckoning", published(0), published(1), mean_of(tables.dead_reckoning_ate_m), tables));
  for (const FingerprintCell& cell : tables.cells)
    table.rows.push_back(row_of(label_of(cell), published_ate_m(0, cell), published_ate_m(1, cell),
                                mean_of(cell.ate_m), tables));
  return table;
}

}  // namespace radioslam
