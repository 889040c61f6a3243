#include "radioslam/io/text/named_columns.hpp"

#include <algorithm>
#include <cmath>
#include <regex>

#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/wifi/log_time.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam {
namespace {

constexpr const char* kTimeNames =
    "(?:.*_)?(?:t|sec|secs|seconds|millis|stamp|[a-z]*time[a-z]*|(?:first|last)_?seen)(?:_.*)?";

/// The first line that is not a comment.
std::string_view head_of(std::string_view content) {
  while (content.starts_with('#'))
    content.remove_prefix(std::min(content.find('\n'), content.size() - 1) + 1);
  return content.substr(0, content.find('\n'));
}

/// The exponent that makes the numbers of a column seconds, if its name states a unit.
const char* exponent_of(const std::string& name) {
  struct Unit {
    const char *form, *exponent;
  };
  static constexpr Unit kUnits[] = {{"(?:.*_)?(?:ms|millis|msec|milliseconds)", "e-3"},
                                    {"(?:.*_)?(?:us|micros|usec|microseconds)", "e-6"},
                                    {"(?:.*_)?(?:ns|nanos|nsec|nanoseconds)", "e-9"}};
  for (const Unit& unit : kUnits)
    if (std::regex_match(name, std::regex(unit.form))) return unit.exponent;
  return "";
}

/// Digits of the microseconds since boot, from 2.8 hours to 11 days; as seconds they would be no time.
bool counts_since_boot(std::string_view field) {
  const std::size_t digits = field.find_first_not_of("0123456789");
  return digits == std::string_view::npos && (field.size() == 11 || field.size() == 12);
}

}  // namespace

std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : lower_case(name)) {
    const bool is_word = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_word)
      plain += c;
    else if (!plain.empty() && plain.back() != '_')
      plain += '_';
  }
  while (plain.ends_with('_')) plain.pop_back();
  return plain;
}

Text with_commas(Text table) {
  const std::string_view head = head_of(table.content);
  if (head.find(',') != std::string_view::npos) return table;
  if (head.find(';') != std::string_view::npos) {
    std::replace(table.content.begin(), table.content.end(), ',', '.');
    std::replace(table.content.begin(), table.content.end(), ';', ',');
  }
  std::replace(table.content.begin(), table.content.end(), '\t', ',');
  return table;
}

NamedColumns::NamedColumns(const CsvReader& csv) {
  for (const std::string_view name : csv.names()) names_.push_back(plain_name(name));
}

std::optional<std::size_t> NamedColumns::find(const std::string& form) const {
  const std::regex expression(form);
  for (std::size_t k = 0; k < names_.size(); ++k)
    if (std::regex_match(names_[k], expression)) return k;
  return std::nullopt;
}

std::optional<std::size_t> NamedColumns::find_time() const { return find(kTimeNames); }

ReadTime time_in(const CsvReader& csv, std::size_t column, const std::string& name) {
  const std::string_view field = csv.field(column);
  const std::string exponent = exponent_of(name);
  ReadTime read;
  if (const auto stamp = exponent.empty() && !counts_since_boot(field)
                             ? std::nullopt
                             : parse_stamp(std::string(field) + (exponent.empty() ? "e-6" : exponent)))
    read.stamp = *stamp;
  else if (const auto time = read_printed_time(field); time && time->stamp && time->is_whole)
    read = {*time->stamp, time->zone_known};
  else
    csv.fail(quoted_bytes(field) + " is not understood as a time", InputError::Kind::kClock);
  if (std::abs(read.stamp.seconds()) > kLatestTime_s)
    csv.fail(quoted_bytes(field) + " is not a possible time", InputError::Kind::kClock);
  return read;
}

}  // namespace radioslam
