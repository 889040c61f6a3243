// Study table: what `reproduce` prints, writes as CSV and shows on a page.
#pragma once

#include <optional>
#include <string>
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

}  // namespace radioslam
