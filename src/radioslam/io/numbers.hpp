// Numbers as text: strict, independent of the locale, exact in both directions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// Larger coordinates (metres) are refused as implausible: a slipped column or unit.
inline constexpr double kLargestCoordinate_m = 1e8;

/// The whole token as a finite number ("1.5", "-2e-3", "+7"); nothing otherwise. A number too small for a
/// double is 0.
std::optional<double> parse_number(std::string_view token);
/// The whole token as a whole number that fits.
std::optional<std::int64_t> parse_integer(std::string_view token);
std::optional<std::uint64_t> parse_id(std::string_view token);

/// Decimal seconds ("12", "1574407123.123456789", "1.5e3") to whole nanoseconds, exactly; further digits
/// round to nearest. Nothing if it is no number or beyond the 292 years that fit.
std::optional<Stamp> parse_stamp(std::string_view token);

/// The shortest text that reads back as the same number; appended to `out`.
void append_number(std::string& out, double value);
void append_number(std::string& out, float value);
std::string format_number(double value);
/// Seconds with as many decimals as the nanoseconds need: "0", "12.5", "1574407123.123456789".
std::string format_stamp(Stamp stamp);

}  // namespace radioslam
