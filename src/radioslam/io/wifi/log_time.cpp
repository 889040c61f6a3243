#include "radioslam/io/wifi/log_time.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam {
namespace {

constexpr int kLastHour = 23, kLastMinute = 59, kLeapSecond = 60;
constexpr int kFurthestZone_h = 14;  // Kiribati's
constexpr std::size_t kSecondsDigits = 10, kDigitsPerThousand = 3, kMaxDigits = 19;

bool is_decimal(char c) { return c >= '0' && c <= '9'; }

/// Removes a number of the given number of digits from the front.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return std::nullopt;
  int value = 0;
  for (const char c : text.substr(0, digits)) {
    if (!is_decimal(c)) return std::nullopt;
    value = 10 * value + (c - '0');
  }
  text.remove_prefix(digits);
  return value;
}

bool take_one_of(std::string_view& text, std::string_view characters) {
  if (text.empty() || characters.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

/// A number of two digits, at most `most`.
std::optional<int> take_two_digits(std::string_view& text, int most) {
  const auto number = take_digits(text, 2);
  return number && *number <= most ? number : std::nullopt;
}

/// "07:18:43" as seconds since midnight; a leap second counts as the first second of the next minute.
std::optional<int> take_time_of_day_s(std::string_view& text) {
  const auto hours = take_two_digits(text, kLastHour);
  if (!hours || !take_one_of(text, ":")) return std::nullopt;
  const auto minutes = take_two_digits(text, kLastMinute);
  if (!minutes || !take_one_of(text, ":")) return std::nullopt;
  const auto seconds = take_two_digits(text, kLeapSecond);
  if (!seconds) return std::nullopt;
  return *hours * kSecondsPerHour + *minutes * kSecondsPerMinute + *seconds;
}

/// The fraction after the seconds (".5" or ",5") in nanoseconds; 0 if there is none.
std::optional<std::int64_t> take_fraction_ns(std::string_view& text) {
  if (!take_one_of(text, ".,")) return 0;
  std::size_t end = 0;
  while (end < text.size() && is_decimal(text[end])) ++end;
  const auto fraction = parse_stamp("0." + std::string(text.substr(0, end)));
  if (end == 0 || !fraction) return std::nullopt;
  text.remove_prefix(end);
  return fraction->ns;
}

std::optional<std::chrono::sys_days> take_date(std::string_view& text) {
  const auto year = take_digits(text, 4);
  if (!year || !take_one_of(text, "-")) return std::nullopt;
  const auto month = take_digits(text, 2);
  if (!month || !take_one_of(text, "-")) return std::nullopt;
  const auto day = take_digits(text, 2);
  if (!day) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  return date.ok() ? std::optional(std::chrono::sys_days(date)) : std::nullopt;
}

/// Date and time of day, separated by 'T' or a blank.
std::optional<Stamp> take_calendar_time(std::string_view& text) {
  const auto days = take_date(text);
  if (!days || !take_one_of(text, "T ")) return std::nullopt;
  const auto seconds = take_time_of_day_s(text);
  const auto fraction_ns = seconds ? take_fraction_ns(text) : std::nullopt;
  if (!fraction_ns) return std::nullopt;
  const std::int64_t midnight_s = std::chrono::seconds(days->time_since_epoch()).count();
  const std::int64_t s = midnight_s + *seconds;
  if (s < 0 || static_cast<double>(s) >= kLatestTime_s) return std::nullopt;
  return Stamp{s * kNanosecondsPerSecond + *fraction_ns};
}

/// Offset from UTC in seconds, for "Z", "+01:00" or "+0100".
std::optional<int> take_zone_s(std::string_view& text) {
  if (take_one_of(text, "Z")) return 0;
  const bool is_west = text.starts_with('-');
  if (!take_one_of(text, "+-")) return std::nullopt;
  const auto hours = take_two_digits(text, kFurthestZone_h);
  take_one_of(text, ":");
  const auto minutes = hours ? take_two_digits(text, kLastMinute) : std::nullopt;
  if (!minutes) return std::nullopt;
  const int east_s = *hours * kSecondsPerHour + *minutes * kSecondsPerMinute;
  if (east_s > kFurthestZone_h * kSecondsPerHour) return std::nullopt;
  return is_west ? -east_s : east_s;
}

std::optional<Stamp> parse_plain_seconds(std::string_view text) {
  if (text.empty() || !is_decimal(text.front())) return std::nullopt;
  if (text.find_first_not_of("0123456789.") != std::string_view::npos) return std::nullopt;
  const auto stamp = parse_stamp(text);
  return stamp && stamp->seconds() < kLatestTime_s ? stamp : std::nullopt;
}

std::optional<Stamp> parse_zoned_time(std::string_view text) {
  const auto stamp = take_calendar_time(text);
  if (!stamp) return std::nullopt;
  const auto east_s = take_zone_s(text);
  if (!east_s || !text.empty()) return std::nullopt;
  return Stamp{stamp->ns - *east_s * kNanosecondsPerSecond};
}

/// A run of digits as seconds, milli-, micro- or nanoseconds, depending on its length.
std::optional<Stamp> epoch_time(std::string_view digits, std::string_view behind) {
  if (digits.size() < kSecondsDigits || digits.size() > kMaxDigits ||
      (digits.size() - kSecondsDigits) % kDigitsPerThousand != 0)
    return std::nullopt;
  std::string seconds(digits.substr(0, kSecondsDigits));
  (seconds += '.') += digits.substr(kSecondsDigits);
  const bool has_fraction = digits.size() == kSecondsDigits && take_one_of(behind, ".");
  for (std::size_t k = 0; has_fraction && k < behind.size() && is_decimal(behind[k]); ++k)
    seconds += behind[k];
  return parse_plain_seconds(seconds);
}

}  // namespace

std::optional<Stamp> parse_time_line(std::string_view line) {
  while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
  const auto seconds = parse_plain_seconds(line);
  return seconds ? seconds : parse_zoned_time(line);
}

std::optional<Stamp> parse_calendar_time(std::string_view text) {
  const auto stamp = take_calendar_time(text);
  return stamp && text.empty() ? stamp : std::nullopt;
}

std::optional<Stamp> time_in_name(std::string_view stem) {
  while (!stem.empty()) {
    std::size_t end = 0;
    while (end < stem.size() && is_decimal(stem[end])) ++end;
    if (const auto stamp = epoch_time(stem.substr(0, end), stem.substr(end))) return stamp;
    stem.remove_prefix(std::max<std::size_t>(end, 1));
  }
  return std::nullopt;
}

Stamp time_of_last_write(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw InputError(path.string(), 0, "no such file");
  if (std::abs(static_cast<double>(status.st_mtim.tv_sec)) > kLatestTime_s)
    throw InputError(path.string(), 0, "has an implausible modification time");
  return {status.st_mtim.tv_sec * kNanosecondsPerSecond + status.st_mtim.tv_nsec};
}

}  // namespace radioslam
