// Parses times that accompany the output of tools: lines of `date +%s.%N` or `date -Ins`, file names, file
// times.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// Parses a line that consists of a time only: non-negative seconds ("1574407123.123", of any clock), or ISO
/// 8601 with a time zone ("2019-11-22T07:18:43,123+00:00", "...Z"). Nothing for other lines and implausible
/// times.
std::optional<Stamp> parse_time_line(std::string_view line);

/// Parses "2019-11-22 07:18:43", with or without a fraction, as UTC.
std::optional<Stamp> parse_calendar_time(std::string_view text);

/// The Unix time in a file name: its first run of 10, 13, 16 or 19 digits, as seconds, milli-, micro- or
/// nanoseconds; seconds may have a fraction: "scan-1574407123.5" (without the extension).
std::optional<Stamp> time_in_name(std::string_view stem);

/// The time at which a file was last modified. Refuses (InputError) a missing file and implausible times.
Stamp time_of_last_write(const std::filesystem::path& path);

}  // namespace radioslam
