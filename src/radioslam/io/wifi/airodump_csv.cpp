#include "radioslam/io/wifi/airodump_csv.hpp"

#include <algorithm>
#include <array>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/wifi/log_time.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kNetworksHead = "BSSID, First time seen", kStationsHead = "Station MAC,",
                           kRecordsHead = "LocalTime,";
constexpr const char* kNoPower = "rows have no power and are left out";
constexpr std::int64_t kUnknownPower = -1;
constexpr std::size_t kMaxName = 32;  // bytes of an SSID

/// Builds rows; shared by both tables.
class AirodumpRows {
 public:
  AirodumpRows(const Text& text, const AirodumpParams& params)
      : text_(text), offset_s_(params.clock_offset_s - params.utc_offset_h * kSecondsPerHour) {}

  void add(std::size_t line, std::string_view time, std::string_view address, std::string_view power,
           double frequency_mhz) {
    const auto stamp = parse_calendar_time(trim(time));
    if (!stamp) text_.fail(line, quoted_bytes(trim(time)) + " is not a valid time");
    const auto bssid = parse_bssid(trim(address));
    if (!bssid) text_.fail(line, quoted_bytes(trim(address)) + " is not a valid BSSID");
    const auto power_dbm = parse_integer(trim(power));
    if (!power_dbm) text_.fail(line, quoted_bytes(trim(power)) + " is not a valid power");
    if (*power_dbm == kUnknownPower) {
      ++log.counts[kNoPower];
      return;
    }
    log.rows.push_back({on_clock_ahead_by(offset_s_, *stamp), *bssid, static_cast<float>(frequency_mhz),
                        static_cast<float>(*power_dbm)});
  }

  [[noreturn]] void fail(std::size_t line, const std::string& reason) const { text_.fail(line, reason); }

  /// Reads a row; a refused one is counted.
  template <class Read>
  void attempt(Read&& read) {
    if (skipped_.attempt(read)) ++read_;
  }

  WifiLog take() {
    for (std::string& warning : log.warnings) warning = text_.name + ": " + warning;
    skipped_.conclude(text_.name, "row", read_, log.warnings);
    return std::move(log);
  }

  WifiLog log;

 private:
  const Text& text_;
  double offset_s_ = 0;
  SkippedRecords skipped_;
  std::size_t read_ = 0;
};

/// Reads a table byte by byte, because names may contain line ends.
class NetworksReader {
 public:
  NetworksReader(const Text& text, std::size_t line, std::size_t at, AirodumpRows& rows)
      : bytes_(text.content), line_(line), at_(at), rows_(rows) {}

  void read() {
    while (at_ < bytes_.size()) {
      const std::string_view line = rest_of_line();
      if (line.starts_with(kStationsHead)) return;
      if (trim(line).empty())
        skip_to(end_of_line(at_));
      else
        rows_.attempt([&] { read_row(); });
    }
  }

 private:
  enum Column : std::size_t {
    kBssid,
    kFirstSeen,
    kLastSeenColumn,
    kChannel,
    kPower = 8,
    kIdLength = 12,
    kColumns
  };

  std::size_t end_of_line(std::size_t from) const { return std::min(bytes_.find('\n', from), bytes_.size()); }

  std::string_view rest_of_line() const {
    std::string_view line = bytes_.substr(at_, end_of_line(at_) - at_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  /// Advances past a line end.
  void skip_to(std::size_t end) {
    const auto begin = bytes_.begin();
    const std::size_t next = std::min(end + 1, bytes_.size());
    line_ += static_cast<std::size_t>(std::count(begin + static_cast<std::ptrdiff_t>(at_),
                                                 begin + static_cast<std::ptrdiff_t>(next), '\n'));
    at_ = next;
  }

  /// Advances behind the row, or behind its line before it is refused.
  void read_row() {
    const std::string_view line = rest_of_line();
    const std::size_t row = at_, number = line_;
    skip_to(end_of_line(at_));
    std::array<std::string_view, kColumns> fields;
    std::size_t begin = 0;
    for (std::string_view& field : fields) {
      const std::size_t comma = line.find(',', begin);
      if (comma == std::string_view::npos) return read_torn_row(number);
      field = line.substr(begin, comma - begin);
      begin = comma + 1;
    }
    const auto channel = parse_integer(trim(fields[kChannel]));
    if (!channel) rows_.fail(number, quoted_bytes(trim(fields[kChannel])) + " is not a valid channel");
    const double carrier_hz = carrier_of_channel_hz(*channel).value_or(0);
    const std::size_t end = end_of_row(number, row + begin, trim(fields[kIdLength]));
    if (end >= at_) skip_to(end);
    rows_.add(number, fields[kLastSeenColumn], fields[kBssid], fields[kPower], carrier_hz / kHzPerMhz);
  }

  /// airodump rewrites its file while it runs, so the last row may be truncated.
  void read_torn_row(std::size_t number) {
    if (at_ < bytes_.size() || bytes_.ends_with('\n')) rows_.fail(number, "the row ends before its ESSID");
    rows_.log.warnings.push_back("the file ends within a row, which is left out");
  }

  /// End of the row whose name has the stated length and begins after the blank at `name`.
  std::size_t end_of_row(std::size_t number, std::size_t name, std::string_view id_length) const {
    const auto length = parse_id(id_length);
    if (!length) rows_.fail(number, quoted_bytes(id_length) + " is not a valid ID-length");
    const std::size_t behind =
        name + 1 + static_cast<std::size_t>(std::min<std::uint64_t>(*length, kMaxName));
    const bool is_whole = behind < bytes_.size() && bytes_[behind] == ',';
    return end_of_line(is_whole ? behind : name);  // escaped names are longer and contain no line end
  }

  std::string_view bytes_;
  std::size_t line_, at_;
  AirodumpRows& rows_;
};

/// The fields of a record; the third one, the name, may contain commas and line ends.
class RecordFields {
 public:
  enum Behind : std::size_t {
    kBssid,
    kPower,
    kSecurity,
    kLatitude,
    kLongitude,
    kError1,
    kError2,
    kType,
    kFields
  };

  explicit RecordFields(std::string_view record) {
    time = record.substr(0, record.find(','));
    for (std::size_t k = kFields; k-- > 0;) {
      const std::size_t comma = record.rfind(',');
      if (comma == std::string_view::npos) return;
      behind[k] = trim(record.substr(comma + 1));
      record = record.substr(0, comma);
    }
    is_whole = (behind[kType] == "AP" || behind[kType] == "Client") && parse_bssid(behind[kBssid]);
  }

  std::string_view time;
  std::array<std::string_view, kFields> behind;
  bool is_whole = false;
};

/// Reads the log of receptions, whose records may go over several lines.
class RecordsReader {
 public:
  RecordsReader(TextLines& lines, AirodumpRows& rows) : lines_(lines), rows_(rows) {}

  void read() {
    while (lines_.next()) {
      if (record_.empty() && trim(lines_.line()).empty()) continue;
      if (!record_.empty() && (begins_with_time() || ends_ > kMaxName)) refuse();
      if (record_.empty()) first_ = lines_.number(), ends_ = 0;
      (record_ += ends_++ > 0 ? "\n" : "") += lines_.line();
      const RecordFields fields(record_);
      if (!fields.is_whole) continue;
      rows_.attempt([&] { add(fields); });
      record_.clear();
    }
    if (record_.empty()) return;
    if (lines_.terminated()) return refuse();
    rows_.log.warnings.push_back("the file ends within a row, which is left out");
  }

 private:
  bool begins_with_time() const {
    return parse_calendar_time(trim(lines_.line().substr(0, lines_.line().find(',')))).has_value();
  }

  void add(const RecordFields& fields) {
    if (fields.behind[RecordFields::kType] == "AP")
      rows_.add(first_, fields.time, fields.behind[RecordFields::kBssid], fields.behind[RecordFields::kPower],
                0);
  }

  void refuse() {
    rows_.attempt([&] { rows_.fail(first_, "not a row of airodump's log"); });
    record_.clear();
  }

  TextLines& lines_;
  AirodumpRows& rows_;
  std::string record_;
  std::size_t first_ = 0, ends_ = 0;
};

}  // namespace

WifiLog read_airodump(const Text& text, const AirodumpParams& params) {
  AirodumpRows rows(text, params);
  TextLines lines(text);
  while (lines.next() && trim(lines.line()).empty()) {
  }
  if (lines.line().starts_with(kNetworksHead)) {
    const char* behind = lines.line().data() + lines.line().size();
    const std::size_t end = text.content.find('\n', static_cast<std::size_t>(behind - text.content.data()));
    const std::size_t at = end == std::string::npos ? text.content.size() : end + 1;
    NetworksReader(text, lines.number() + 1, at, rows).read();
  } else if (lines.line().starts_with(kRecordsHead)) {
    RecordsReader(lines, rows).read();
  } else {
    text.fail(lines.number(), "neither the header of airodump's CSV nor that of its log");
  }
  return rows.take();
}

}  // namespace radioslam
