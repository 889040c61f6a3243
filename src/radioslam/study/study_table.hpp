// A table to read: what `reproduce` prints, writes as CSV and shows on a page.
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

/// In lines, the columns aligned; notes below, wrapped.
std::string table_text(const StudyTable& table);
/// The rows alone, with a header; texts in double quotes.
std::string table_csv(const StudyTable& table);

/// `value` with so many decimals and commas between thousands; "–" where there is none.
std::string number_text(std::optional<double> value, int decimals);
/// A share in percent.
std::string percent_text(std::optional<double> share, int decimals);

/// The middle of the values; the mean of the two in the middle of an even number; nothing of none.
std::optional<double> median_of(std::vector<double> values);

}  // namespace radioslam
