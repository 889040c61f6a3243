// Times as people write them beside what a tool prints: `date +%s.%N`, `date -Ins`, names of files.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// A line that is a time and nothing else: seconds ("1574407123.123", of any clock, not negative), or ISO
/// 8601 with its zone ("2019-11-22T07:18:43,123+00:00", "...Z"). Nothing for other lines and implausible
/// times.
std::optional<Stamp> parse_time_line(std::string_view line);

/// "2019-11-22 07:18:43", with a fraction or without, as a clock at Greenwich shows it.
std::optional<Stamp> parse_calendar_time(std::string_view text);

/// The first run of 10, 13, 16 or 19 digits in a file's name, as seconds, milli-, micro- or nanoseconds of
/// the Unix epoch; a fraction may follow the seconds: "scan-1574407123.5" (without the extension).
std::optional<Stamp> time_in_name(std::string_view stem);

/// When a file was last written. Refuses (InputError) one that is not there, and implausible times.
Stamp time_of_last_write(const std::filesystem::path& path);

}  // namespace radioslam
