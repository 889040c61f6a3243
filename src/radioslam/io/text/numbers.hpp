// Conversion between numbers and text: strict, independent of the locale, exact in both directions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// Larger coordinates in metres are refused as implausible (wrong column or unit).
inline constexpr double kMaxCoordinate_m = 1e8;

/// Parses the whole token as a finite number ("1.5", "-2e-3", "+7"); nothing if it is malformed. A number too
/// small for a double is read as 0.
std::optional<double> parse_number(std::string_view token);
/// Parses the whole token as an integer that fits the type.
std::optional<std::int64_t> parse_integer(std::string_view token);
std::optional<std::uint64_t> parse_id(std::string_view token);

/// Converts decimal seconds ("12", "1574407123.123456789", "1.5e3") exactly to nanoseconds; further digits
/// are rounded to nearest. Nothing if the token is malformed or outside the representable 292 years.
std::optional<Stamp> parse_stamp(std::string_view token);

/// Appends the shortest text that reads back as the same number.
void append_number(std::string& out, double value);
void append_number(std::string& out, float value);
std::string format_number(double value);
/// Seconds with as many decimals as the stamp has nanosecond digits: "0", "12.5", "1574407123.123456789".
std::string format_stamp(Stamp stamp);

}  // namespace radioslam
