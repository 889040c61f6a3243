// Comma-separated values with a header line. Columns are found by their names, in any order; further ones
// are ignored. Fields may stand in double quotes but hold no comma. Blank lines and '#' comments are skipped.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

/// Reads row by row: `while (csv.next()) use(csv.number(kX))`. Refusals name file, line and column.
class CsvReader {
 public:
  /// Columns that must be there, and columns that may be.
  struct Columns {
    std::vector<std::string_view> required;
    std::vector<std::string_view> optional = {};
  };

  /// Reads the header; refuses a missing or doubled column.
  CsvReader(const Text& text, const Columns& columns);

  /// Moves to the next row; refuses one with more or fewer fields than the header.
  bool next();

  /// Column numbers count through the required columns and on through the optional ones.
  bool has(std::size_t column) const { return places_[column].has_value(); }
  std::string_view field(std::size_t column) const { return fields_[*places_[column]]; }
  /// Whether the row has something in a column that may be missing or empty.
  bool given(std::size_t column) const { return has(column) && !field(column).empty(); }
  double number(std::size_t column) const;
  double coordinate(std::size_t column) const;
  double sigma(std::size_t column) const;
  Stamp stamp(std::size_t column) const;
  /// qx qy qz qw from four columns on, normalised.
  Eigen::Quaterniond quaternion(std::size_t column) const;

  [[noreturn]] void fail(const std::string& reason) const { lines_.fail(reason); }

 private:
  void split(std::string_view line);
  void find(std::string_view name, bool required);

  TextLines lines_;
  std::vector<std::string_view> names_;
  std::vector<std::optional<std::size_t>> places_;
  std::vector<std::string_view> fields_;
  std::size_t width_ = 0;
};

}  // namespace radioslam
