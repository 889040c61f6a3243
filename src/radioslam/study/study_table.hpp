// Study table: what `reproduce` prints, writes as CSV and shows on a page.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace radioslam {

struct StudyRow {
  std::string label;
  std::vector<std::string> cells;  ///< one per column
};

struct StudyTable {
  std::string title;
  std::string lead;                  ///< what was done, in a sentence or two
  std::vector<std::string> columns;  ///< without that of the labels
  std::vector<StudyRow> rows;
  std::vector<std::string> notes;
};

/// As text with aligned columns and wrapped notes below.
std::string table_text(const StudyTable& table);
/// Only the rows, with a header; texts in double quotes.
std::string table_csv(const StudyTable& table);

/// `value` with `decimals` decimals and commas between thousands; "–" if missing.
std::string number_text(std::optional<double> value, int decimals);
/// A ratio in percent.
std::string percent_text(std::optional<double> ratio, int decimals);

/// Median; the mean of the two middle values of an even number; nothing if there are none.
std::optional<double> median_of(std::vector<double> values);

/// Median over the seeds for which `value` returns one.
template <class Seed, class Value>
std::optional<double> median_over(const std::vector<Seed>& seeds, const Value& value) {
  std::vector<double> values;
  for (const Seed& seed : seeds)
    if (const std::optional<double> v = value(seed)) values.push_back(*v);
  return median_of(std::move(values));
}

/// "Seed 3", or "Medians of 5 seeds from 3 on".
std::string seeds_text(std::uint64_t first, std::size_t count);

}  // namespace radioslam
