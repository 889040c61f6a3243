#include "radioslam/io/text/csv.hpp"

#include <algorithm>
#include <set>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/line_fields.hpp"

namespace radioslam {
namespace {

bool is_quoted(std::string_view field) {
  return field.size() >= 2 && field.front() == '"' && field.back() == '"';
}

/// The field without surrounding blanks and double quotes; blanks inside the quotes are removed as well.
std::string_view bare(std::string_view field) {
  field = trim(field);
  while (is_quoted(field)) field = trim(field.substr(1, field.size() - 2));
  return field;
}

constexpr std::string_view kBlanks = " \t";

bool starts_with_quote(std::string_view line, std::size_t begin) {
  const std::size_t first = line.find_first_not_of(kBlanks, begin);
  return first != std::string_view::npos && line[first] == '"';
}

/// End of the quoted field that begins at `begin`: the comma after its closing quote, or the end of the line.
/// Nothing if its quote is never closed.
std::optional<std::size_t> end_of_quoted(std::string_view line, std::size_t begin) {
  const std::size_t opening = line.find('"', begin);
  for (std::size_t quote = line.find('"', opening + 1); quote != std::string_view::npos;
       quote = line.find('"', quote + 1)) {
    const std::size_t after = line.find_first_not_of(kBlanks, quote + 1);
    if (after == std::string_view::npos) return line.size();
    if (line[after] == ',') return after;
  }
  return std::nullopt;
}

}  // namespace

CsvReader::CsvReader(const Text& text) : lines_(text) {
  read_header(text);
  names_ = fields_;
  for (std::size_t k = 0; k < names_.size(); ++k) places_.emplace_back(k);
}

CsvReader::CsvReader(const Text& text, const Columns& columns) : lines_(text) {
  read_header(text);
  for (const auto name : columns.required) find(name, true);
  for (const auto name : columns.optional) find(name, false);
}

void CsvReader::read_header(const Text& text) {
  if (!lines_.next_with_content()) text.fail(1, "the file has no header line", InputError::Kind::kTooLittle);
  split(lines_.line());
  width_ = fields_.size();
}

void CsvReader::split(std::string_view line) {
  fields_.clear();
  bool quotes_close = true;  // if one is never closed, none after it is: keeps the cost linear
  for (std::size_t begin = 0; begin <= line.size();) {
    std::size_t end = std::min(line.find(',', begin), line.size());
    if (quotes_close && starts_with_quote(line, begin)) {
      const auto closed = end_of_quoted(line, begin);
      quotes_close = closed.has_value();
      end = closed.value_or(end);
    }
    fields_.push_back(bare(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

std::size_t CsvReader::column(std::string_view name) const {
  const auto place = std::find(names_.begin(), names_.end(), name);
  if (place == names_.end())
    fail("the column '" + std::string(name) + "' is missing", InputError::Kind::kColumnOrder);
  return static_cast<std::size_t>(place - names_.begin());
}

void CsvReader::find(std::string_view name, bool required) {
  const auto count = std::count(fields_.begin(), fields_.end(), name);
  if (count > 1 || (count == 0 && required))
    fail("the column '" + std::string(name) + (count > 1 ? "' appears twice" : "' is missing"),
         InputError::Kind::kColumnOrder);
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
    fail("the row has " + std::to_string(fields_.size()) + " fields, but the header " +
         std::to_string(width_) + torn);
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

std::vector<std::filesystem::path> find_csv_files(const std::filesystem::path& source) {
  std::vector<std::filesystem::path> files{source};
  if (std::filesystem::is_directory(source))
    files = files_in(source, Depth::kBelow,
                     [](const std::filesystem::path& file) { return file.extension() == ".csv"; });
  if (files.empty()) throw InputError(source.string(), 0, "contains no *.csv");
  std::set<std::string> names;
  for (const auto& file : files) {
    const std::string name = file.stem().string();
    if (!is_valid_id(name)) throw InputError(file.string(), 0, "its name is not a valid robot name");
    if (!names.insert(name).second) throw InputError(file.string(), 0, "another file has the same name");
  }
  return files;
}

std::string name_of_source(const std::filesystem::path& source) {
  const std::filesystem::path path = std::filesystem::absolute(source).lexically_normal();
  return (path.filename().empty() ? path.parent_path() : path).stem().string();
}

}  // namespace radioslam
