// CSV tables with a header line. Columns are found by name, in any order; unknown columns are ignored. Fields
// may be enclosed in double quotes, between which commas do not separate fields. Blank lines and '#' comments
// are skipped.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Reads row by row: `while (csv.next()) use(csv.number(kX))`. Errors (InputError) name file, line and
/// column.
class CsvReader {
 public:
  /// Required and optional columns.
  struct Columns {
    std::vector<std::string_view> required;
    std::vector<std::string_view> optional = {};
  };

  /// Reads the header; refuses missing and repeated columns.
  CsvReader(const Text& text, const Columns& columns);
  /// Reads the header; all its columns are wanted, and are numbered as in the file.
  explicit CsvReader(const Text& text);

  /// Advances to the next row; refuses a row with more or fewer fields than the header.
  bool next();

  /// Names of the columns.
  const std::vector<std::string_view>& names() const { return names_; }
  /// Number of the first column with this name; refuses a missing one.
  std::size_t column(std::string_view name) const;

  /// Columns are numbered from the first required one on; the optional ones follow.
  bool has(std::size_t column) const { return places_[column].has_value(); }
  std::string_view field(std::size_t column) const { return fields_[*places_[column]]; }
  /// Whether the column exists and is not empty in this row.
  bool given(std::size_t column) const { return has(column) && !field(column).empty(); }
  double number(std::size_t column) const;
  double coordinate(std::size_t column) const;
  double sigma(std::size_t column) const;
  Stamp stamp(std::size_t column) const;
  /// qx qy qz qw in four consecutive columns, normalised.
  Eigen::Quaterniond quaternion(std::size_t column) const;

  /// The current line, for errors.
  const TextLines& at() const { return lines_; }
  [[noreturn]] void fail(const std::string& reason,
                         InputError::Kind kind = InputError::Kind::kUnreadable) const {
    lines_.fail(reason, kind);
  }

 private:
  void read_header(const Text& text);
  void split(std::string_view line);
  void find(std::string_view name, bool required);

  TextLines lines_;
  std::vector<std::string_view> names_;
  std::vector<std::optional<std::size_t>> places_;
  std::vector<std::string_view> fields_;
  std::size_t width_ = 0;
};

// Finds the CSV files of an external data set.

/// The file itself, or every *.csv below the folder, sorted by name. Refuses (InputError) a source without
/// CSV files, and file names that are not valid robot names or appear twice.
std::vector<std::filesystem::path> find_csv_files(const std::filesystem::path& source);

/// Name of a data set: that of its folder, or of its file without the extension.
std::string name_of_source(const std::filesystem::path& source);

}  // namespace radioslam
