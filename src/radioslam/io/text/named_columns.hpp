// Finds the columns of CSV tables that other programs name in their own ways, and reads their times.
//
// Names are compared in lower case, with '_' for everything that is neither a letter nor a digit:
// "Acceleration x (m/s^2)" is "acceleration_x_m_s_2". Tables may have commas, tabs, or semicolons and then
// decimal commas.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// The name in lower case, with '_' for other characters.
std::string plain_name(std::string_view name);

/// The table with commas between the fields and points in numbers.
Text with_commas(Text table);

/// The columns of a table by their names.
class NamedColumns {
 public:
  explicit NamedColumns(const CsvReader& csv);

  /// The first column whose whole name has the form of a regular expression (ECMAScript).
  std::optional<std::size_t> find(const std::string& form) const;
  /// The first column with a name of a time: t_s, time, timestamp, seconds, FirstSeen, ...
  std::optional<std::size_t> find_time() const;
  const std::string& name(std::size_t column) const { return names_[column]; }

 private:
  std::vector<std::string> names_;
};

/// A time as programs write it, and what had to be assumed.
struct ReadTime {
  Stamp stamp;
  bool zone_known = true;  ///< false: a date without a time zone, taken as UTC
};

/// Reads the field of a column of times: in the unit that the column's name states (time_ms), otherwise
/// seconds, Unix times in ms, us or ns by their digits, dates (log_time.hpp), or the microseconds since boot
/// that Android's scan results have (11 or 12 digits). Refuses (InputError) anything else.
ReadTime time_in(const CsvReader& csv, std::size_t column, const std::string& name);

}  // namespace radioslam
