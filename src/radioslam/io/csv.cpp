#include "radioslam/io/csv.hpp"

#include <algorithm>

#include "radioslam/io/fields_of_line.hpp"

namespace radioslam {
namespace {

bool is_quoted(std::string_view field) {
  return field.size() >= 2 && field.front() == '"' && field.back() == '"';
}

/// Without the blanks and the double quotes around it, inside the quotes too: written bare, it reads the
/// same.
std::string_view bare(std::string_view field) {
  field = trim(field);
  while (is_quoted(field)) field = trim(field.substr(1, field.size() - 2));
  return field;
}

}  // namespace

CsvReader::CsvReader(const Text& text, const Columns& columns) : lines_(text) {
  if (!lines_.next_with_content()) text.fail(1, "the file has no header line");
  split(lines_.line());
  width_ = fields_.size();
  for (const auto name : columns.required) find(name, true);
  for (const auto name : columns.optional) find(name, false);
}

void CsvReader::split(std::string_view line) {
  fields_.clear();
  std::size_t begin = 0;
  for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',', begin)) {
    fields_.push_back(bare(line.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  fields_.push_back(bare(line.substr(begin)));
}

void CsvReader::find(std::string_view name, bool required) {
  const auto count = std::count(fields_.begin(), fields_.end(), name);
  if (count > 1) fail("the column '" + std::string(name) + "' stands there twice");
  if (count == 0 && required) fail("the column '" + std::string(name) + "' is missing");
  names_.push_back(name);
  places_.emplace_back();
  if (count == 1)
    places_.back() =
        static_cast<std::size_t>(std::find(fields_.begin(), fields_.end(), name) - fields_.begin());
}

bool CsvReader::next() {
  if (!lines_.next_with_content()) return false;
  split(lines_.line());
  if (fields_.size() != width_) {
    const std::string torn = lines_.terminated() ? "" : " (the file ends in this line)";
    fail("the row has " + std::to_string(fields_.size()) + " fields, the header " + std::to_string(width_) +
         torn);
  }
  return true;
}

double CsvReader::number(std::size_t column) const {
  return number_in(lines_, field(column), names_[column]);
}
double CsvReader::coordinate(std::size_t column) const {
  return coordinate_in(lines_, field(column), names_[column]);
}
double CsvReader::sigma(std::size_t column) const { return sigma_in(lines_, field(column), names_[column]); }
Stamp CsvReader::stamp(std::size_t column) const { return stamp_in(lines_, field(column), names_[column]); }
Eigen::Quaterniond CsvReader::quaternion(std::size_t column) const {
  return quaternion_in(lines_, {number(column), number(column + 1), number(column + 2), number(column + 3)},
                       kUnitQuaternionTolerance);
}

}  // namespace radioslam
