// Parses times that accompany the output of tools: lines of `date` and its options, file names, file
// times.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// What a line of its own states about the time at which the lines after it were printed.
struct PrintedTime {
  std::optional<Stamp> stamp;  ///< nothing if the line is a time, but not in a form that is understood
  bool zone_known = true;      ///< false: a date without a known time zone, taken as UTC
  bool is_whole = true;        ///< false: what follows the ten digits of the seconds is not understood
};

/// Reads a line that consists of a time only; nothing for lines that do not look like one:
///   1574407123.123, also with ',', after '@', or in ms, us or ns (13, 16 or 19 digits); fewer digits count
///   as seconds of any clock. A fraction that `date` did not fill in (1574407123.%N of BusyBox, .N of macOS)
///   is left out; so is, marked, whatever else follows ten digits
///   2019-11-22T07:18:43,123+00:00, also with a blank, with Z or without a zone (ISO 8601)
///   Fri Nov 22 07:18:43 UTC 2019, also other orders, AM and PM, and common names of zones (`date`, `date
///   -R`)
std::optional<PrintedTime> read_printed_time(std::string_view line);

/// The time of such a line if all of it is understood, with its time zone; nothing otherwise.
std::optional<Stamp> parse_time_line(std::string_view line);

/// Parses "2019-11-22 07:18:43", with or without a fraction, as UTC.
std::optional<Stamp> parse_calendar_time(std::string_view text);

/// The Unix time in a file name: its first run of 10, 13, 16 or 19 digits, as seconds, milli-, micro- or
/// nanoseconds; seconds may have a fraction: "scan-1574407123.5" (without the extension).
std::optional<Stamp> time_in_name(std::string_view stem);

/// The time at which a file was last modified. Refuses (InputError) a missing file and implausible times.
Stamp time_of_last_write(const std::filesystem::path& path);

}  // namespace radioslam
