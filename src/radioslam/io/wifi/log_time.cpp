#include "radioslam/io/wifi/log_time.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

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

/// Date and time of day of ISO 8601.
std::optional<PrintedTime> parse_iso_time(std::string_view text) {
  const auto stamp = take_calendar_time(text);
  if (!stamp) return std::nullopt;
  if (text.empty()) return PrintedTime{*stamp, false};
  const auto east_s = take_zone_s(text);
  if (!east_s || !text.empty()) return std::nullopt;
  return PrintedTime{Stamp{stamp->ns - *east_s * kNanosecondsPerSecond}};
}

/// Ten digits are seconds, with 13, 16 or 19 they are milli-, micro- or nanoseconds, and fewer are seconds of
/// any clock; `fraction` are further digits.
std::optional<Stamp> seconds_of(std::string_view digits, std::string_view fraction) {
  const std::size_t whole = std::min(digits.size(), kSecondsDigits);
  if ((digits.size() - whole) % kDigitsPerThousand != 0 || digits.size() > kMaxDigits) return std::nullopt;
  std::string seconds(digits.substr(0, whole));
  ((seconds += '.') += digits.substr(whole)) += fraction;
  return parse_plain_seconds(seconds);
}

/// The same of ten or more digits; seconds may have a fraction.
std::optional<Stamp> epoch_time(std::string_view digits, std::string_view behind) {
  if (digits.size() < kSecondsDigits) return std::nullopt;
  const bool has_fraction = digits.size() == kSecondsDigits && take_one_of(behind, ".");
  const std::size_t end = std::min(behind.find_first_not_of("0123456789"), behind.size());
  return seconds_of(digits, has_fraction ? behind.substr(0, end) : std::string_view{});
}

/// Whether the rest of a number is what `date` prints for a fraction that it does not know: "%N", "N", "3N".
bool is_unfilled_fraction(std::string_view rest) {
  constexpr std::size_t kLongest = 4;
  return !rest.empty() && rest.size() <= kLongest && (rest.front() == '%' || rest.back() == 'N');
}

/// "1574407123.25", "@1574407123", "1574407123250", "1574407123.%N".
std::optional<Stamp> parse_epoch(std::string_view line) {
  take_one_of(line, "@");
  const std::size_t end = std::min(line.find_first_not_of("0123456789"), line.size());
  std::string_view digits = line.substr(0, end), rest = line.substr(end);
  if (digits.empty()) return std::nullopt;
  if (take_one_of(rest, ".,")) {
    const std::size_t behind = std::min(rest.find_first_not_of("0123456789"), rest.size());
    if (behind == rest.size()) return behind == 0 ? std::nullopt : seconds_of(digits, rest);
  }
  if (rest.empty()) return seconds_of(digits, {});
  // "17326000003N": the digit before the N was the width of the fraction.
  if (digits.size() == kSecondsDigits + 1 && rest == "N") digits.remove_suffix(1);
  return is_unfilled_fraction(rest) ? seconds_of(digits, {}) : std::nullopt;
}

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// The place of the name that begins like `word`, at least by three letters; counted from 1.
template <std::size_t N>
std::optional<int> place_of(std::string_view word, const std::array<std::string_view, N>& names) {
  constexpr std::size_t kShortest = 3;
  const std::string lower = lower_case(word);
  for (std::size_t k = 0; k < N; ++k)
    if (lower.size() >= kShortest && names[k].starts_with(lower)) return static_cast<int>(k + 1);
  return std::nullopt;
}

constexpr std::array<std::string_view, 12> kMonths = {"january",   "february", "march",    "april",
                                                      "may",       "june",     "july",     "august",
                                                      "september", "october",  "november", "december"};
constexpr std::array<std::string_view, 7> kWeekdays = {"monday", "tuesday",  "wednesday", "thursday",
                                                       "friday", "saturday", "sunday"};

/// Zones whose names are those of one zone only.
struct NamedZone {
  std::string_view name;
  int east_h = 0;
};
constexpr std::array<NamedZone, 19> kZones = {{{"UTC", 0},
                                               {"GMT", 0},
                                               {"Z", 0},
                                               {"WET", 0},
                                               {"WEST", 1},
                                               {"CET", 1},
                                               {"CEST", 2},
                                               {"EET", 2},
                                               {"EEST", 3},
                                               {"MSK", 3},
                                               {"JST", 9},
                                               {"KST", 9},
                                               {"AEST", 10},
                                               {"AEDT", 11},
                                               {"EST", -5},
                                               {"EDT", -4},
                                               {"MDT", -6},
                                               {"PST", -8},
                                               {"PDT", -7}}};

/// The parts of a date in words, in any order.
struct WordedTime {
  std::optional<int> year, month, day, second_of_day, east_s;
  std::int64_t fraction_ns = 0;
  bool is_afternoon = false, is_morning = false, has_zone = false;

  /// Takes one word; false if it is none of the parts, or a part that is there already.
  bool take(std::string_view word) {
    if (word.find(':') != std::string_view::npos && is_decimal(word.front())) return take_time_of_day(word);
    if (word.front() == '+' || word.front() == '-') return take_zone(word);
    if (is_decimal(word.front())) return take_number(word);
    if (const auto name = place_of(word, kMonths)) return set(month, *name);
    if (place_of(word, kWeekdays)) return true;
    const std::string lower = lower_case(word);
    if (lower == "am") return !std::exchange(is_morning, true);
    if (lower == "pm") return !std::exchange(is_afternoon, true);
    return take_zone(word);
  }

  std::optional<PrintedTime> time() const {
    if (!year || !month || !day || !second_of_day) return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year(*year),
                                           std::chrono::month(static_cast<unsigned>(*month)),
                                           std::chrono::day(static_cast<unsigned>(*day))};
    if (!date.ok()) return std::nullopt;
    const std::int64_t midnight_s =
        std::chrono::seconds(std::chrono::sys_days(date).time_since_epoch()).count();
    const std::int64_t s = midnight_s + hours_of_clock_s() - east_s.value_or(0);
    if (s < 0 || static_cast<double>(s) >= kLatestTime_s) return std::nullopt;
    return PrintedTime{Stamp{s * kNanosecondsPerSecond + fraction_ns}, east_s.has_value()};
  }

 private:
  static bool set(std::optional<int>& part, int value) {
    if (part) return false;
    part = value;
    return true;
  }

  /// Seconds since midnight, from those of a clock of 24 or of 12 hours.
  std::int64_t hours_of_clock_s() const {
    constexpr int kHalfDay_s = 12 * kSecondsPerHour;
    if (!is_afternoon && !is_morning) return *second_of_day;
    return *second_of_day % kHalfDay_s + (is_afternoon ? kHalfDay_s : 0);
  }

  bool take_time_of_day(std::string_view word) {
    const std::string padded = (word[1] == ':' ? "0" : "") + std::string(word);
    std::string_view rest = padded;
    const auto seconds = take_time_of_day_s(rest);
    const auto fraction = seconds ? take_fraction_ns(rest) : std::nullopt;
    fraction_ns = fraction.value_or(0);
    return fraction && rest.empty() && set(second_of_day, *seconds);
  }

  bool take_number(std::string_view word) {
    constexpr std::size_t kYearDigits = 4;
    if (word.ends_with('.')) word.remove_suffix(1);
    const auto value = parse_integer(word);
    if (!value || word.size() > kYearDigits || word.size() == 3) return false;
    return set(word.size() == kYearDigits ? year : day, static_cast<int>(*value));
  }

  /// A zone that is not known counts as none.
  bool take_zone(std::string_view word) {
    constexpr std::size_t kHoursOnly = 3, kLongestName = 5;
    if (has_zone) return false;
    has_zone = true;
    if (!is_letter(word.front())) {
      const std::string whole = std::string(word) + (word.size() == kHoursOnly ? "00" : "");
      std::string_view rest = whole;
      east_s = take_zone_s(rest);
      return east_s && rest.empty();
    }
    for (const NamedZone& zone : kZones)
      if (zone.name == word) east_s = zone.east_h * kSecondsPerHour;
    return word.size() <= kLongestName && std::all_of(word.begin(), word.end(), is_letter);
  }
};

std::optional<PrintedTime> parse_worded_time(std::string_view line) {
  WordedTime parts;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(" ,\t"), line.size());
    if (end > 0 && !parts.take(line.substr(0, end))) return std::nullopt;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return parts.time();
}

/// Whether a word is a time of day: "7:18", "07:18:43.5"; not a BSSID.
bool is_time_of_day(std::string_view word) {
  const std::size_t colon = word.find(':');
  if (colon == 0 || colon > 2 || word.find_first_not_of("0123456789:.,+-") != std::string_view::npos)
    return false;
  return std::count(word.begin(), word.end(), ':') <= 2;
}

constexpr std::string_view kBeforeTime = "@[(#= ";

/// Whether a line begins with as many digits as a Unix time has, or has a time of day among its words.
bool looks_like_a_time(std::string_view line) {
  constexpr std::size_t kLongest = 80;
  if (line.size() > kLongest) return false;
  std::string_view rest = line.substr(std::min(line.find_first_not_of(kBeforeTime), line.size()));
  if (std::min(rest.find_first_not_of("0123456789"), rest.size()) >= kSecondsDigits) return true;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find_first_of(" T[]()"), rest.size());
    if (is_time_of_day(rest.substr(0, end))) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

}  // namespace

std::optional<PrintedTime> read_printed_time(std::string_view line) {
  while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
  if (line.empty() || line.front() == ' ' || line.front() == '\t') return std::nullopt;
  if (const auto stamp = parse_epoch(line)) return PrintedTime{*stamp};
  if (const auto time = parse_iso_time(line)) return time;
  if (const auto time = parse_worded_time(line)) return time;
  if (!looks_like_a_time(line)) return std::nullopt;
  line.remove_prefix(line.find_first_not_of(kBeforeTime));
  const std::size_t digits = std::min(line.find_first_not_of("0123456789"), line.size());
  const auto seconds = digits == kSecondsDigits ? seconds_of(line.substr(0, digits), {}) : std::nullopt;
  return PrintedTime{seconds, true, false};
}

std::optional<Stamp> parse_time_line(std::string_view line) {
  const auto time = read_printed_time(line);
  return time && time->zone_known && time->is_whole ? time->stamp : std::nullopt;
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
