#include "radioslam/io/text/numbers.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

constexpr int kStampDecimals = 9;
constexpr std::size_t kInt64Digits = 19;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// std::from_chars does not accept '+'.
std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  return token;
}

template <class Number>
std::optional<Number> parse_whole(std::string_view token) {
  Number value{};
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

/// digits * 10^exponent.
struct Decimal {
  bool negative = false;
  std::string digits;  ///< without leading zeros
  std::int64_t exponent = 0;
};

std::optional<Decimal> parse_decimal(std::string_view token) {
  Decimal result;
  std::size_t i = 0;
  if (i < token.size() && (token[i] == '-' || token[i] == '+')) result.negative = token[i++] == '-';
  bool any_digit = false;
  bool behind_point = false;
  for (; i < token.size() && (is_digit(token[i]) || (token[i] == '.' && !behind_point)); ++i) {
    if (token[i] == '.') {
      behind_point = true;
      continue;
    }
    any_digit = true;
    if (token[i] != '0' || !result.digits.empty()) result.digits += token[i];
    if (behind_point) --result.exponent;
  }
  if (!any_digit) return std::nullopt;
  if (i == token.size()) return result;
  if (token[i] != 'e' && token[i] != 'E') return std::nullopt;
  const auto exponent = parse_whole<std::int32_t>(without_plus(token.substr(i + 1)));
  if (!exponent) return std::nullopt;
  result.exponent += *exponent;
  return result;
}

/// For a number that does not fit a double: whether it is too small rather than too large.
bool underflows(std::string_view token) {
  if (const auto decimal = parse_decimal(token))
    return static_cast<std::int64_t>(decimal->digits.size()) + decimal->exponent < 0;
  return token.find("e-") != std::string_view::npos || token.find("E-") != std::string_view::npos;
}

/// Drops decimals and rounds to nearest; nothing if more than 18 digits remain.
std::optional<std::int64_t> round_to_integer(Decimal decimal) {
  std::string& digits = decimal.digits;
  if (digits.empty()) return 0;
  const std::int64_t length = static_cast<std::int64_t>(digits.size()) + decimal.exponent;
  if (length < 0) return 0;
  if (length > static_cast<std::int64_t>(kInt64Digits)) return std::nullopt;
  const auto kept = static_cast<std::size_t>(length);
  const bool round_up = digits.size() > kept && digits[kept] >= '5';
  digits.resize(kept, '0');
  const auto value = digits.empty() ? std::uint64_t{0} : parse_whole<std::uint64_t>(digits);
  if (!value || *value >= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    return std::nullopt;
  return static_cast<std::int64_t>(*value) + (round_up ? 1 : 0);
}

template <class Number>
void append_shortest(std::string& out, Number value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  out.append(buffer.data(), result.ptr);
}

}  // namespace

std::optional<double> parse_number(std::string_view token) {
  token = without_plus(token);
  double value = 0;
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    if (underflows(token)) return 0.0;
    return std::nullopt;
  }
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view token) {
  return parse_whole<std::int64_t>(without_plus(token));
}

std::optional<std::uint64_t> parse_id(std::string_view token) { return parse_whole<std::uint64_t>(token); }

std::optional<Stamp> parse_stamp(std::string_view token) {
  auto decimal = parse_decimal(token);
  if (!decimal) return std::nullopt;
  decimal->exponent += kStampDecimals;
  const bool negative = decimal->negative;
  const auto ns = round_to_integer(std::move(*decimal));
  if (!ns) return std::nullopt;
  return Stamp{negative ? -*ns : *ns};
}

void append_number(std::string& out, double value) { append_shortest(out, value); }
void append_number(std::string& out, float value) { append_shortest(out, value); }

std::string format_number(double value) {
  std::string out;
  append_number(out, value);
  return out;
}

std::string format_stamp(Stamp stamp) {
  const bool negative = stamp.ns < 0;
  const std::uint64_t ns =
      negative ? -static_cast<std::uint64_t>(stamp.ns) : static_cast<std::uint64_t>(stamp.ns);
  constexpr std::uint64_t kSecond_ns = kNanosecondsPerSecond;
  std::string fraction = std::to_string(ns % kSecond_ns);
  fraction.insert(0, kStampDecimals - fraction.size(), '0');
  fraction.erase(fraction.find_last_not_of('0') + 1);
  return (negative ? "-" : "") + std::to_string(ns / kSecond_ns) + (fraction.empty() ? "" : "." + fraction);
}

}  // namespace radioslam
