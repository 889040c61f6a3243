#include "radioslam/io/wifi/iwlist_scan.hpp"

#include <algorithm>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kCompleted = "Scan completed", kCell = "Cell ",
                           kAddress = "Address:", kFrequencyName = "Frequency", kChannelName = "Channel",
                           kQualityName = "Quality", kLevelName = "Signal level",
                           kExtra = "Extra:", kBeacon = "Last beacon:";
constexpr double kHighestFrequency_mhz = 1e6, kOldestBeacon_s = 1e8;
constexpr const char* kOldLevels = "levels are not marked as new (':') but kept";

/// The text after a name and its '=' or ':'; nothing if the line does not begin with the name.
std::optional<std::string_view> value_behind(std::string_view line, std::string_view name) {
  if (!line.starts_with(name)) return std::nullopt;
  line.remove_prefix(name.size());
  if (!line.starts_with('=') && !line.starts_with(':')) return std::nullopt;
  return trim(line.substr(1));
}

/// The number at the beginning of the text, and the rest.
struct LeadingNumber {
  std::optional<double> value;
  std::string_view unit;
};

LeadingNumber leading_number(std::string_view text) {
  const std::size_t end = std::min(text.find_first_not_of("+-.0123456789"), text.size());
  return {parse_number(text.substr(0, end)), trim(text.substr(end))};
}

/// "2.437 GHz (Channel 6)"
std::optional<double> parse_frequency_mhz(std::string_view text) {
  const auto [value, unit] = leading_number(text);
  const double scale = unit.starts_with("GHz") ? 1e3 : unit.starts_with("MHz") ? 1 : 0;
  const double mhz = value.value_or(0) * scale;
  return mhz > 0 && mhz < kHighestFrequency_mhz ? std::optional(mhz) : std::nullopt;
}

/// Collects the lines of each cell.
class IwlistReader {
 public:
  explicit IwlistReader(const Text& text) : lines_(text) {}

  ScanListLog read(const std::string& name) {
    while (lines_.next()) {
      if (auto list = list_at_time(lines_, log_, foreign_)) {
        begun_ = std::move(*list);
        is_inside_ = false;
      } else {
        read_tolerantly(trim(lines_.line()));
      }
    }
    skipped_.conclude(name, "cell", log_.readings(), log_.warnings);
    foreign_.conclude(name, log_);
    return std::move(log_);
  }

 private:
  ScanListReading& cell() { return log_.scans.back().readings.back(); }
  bool is_torn() const { return !lines_.terminated(); }

  /// A refused line costs the cell that it belongs to.
  void read_tolerantly(std::string_view line) {
    const bool was_inside = is_inside_ && !line.starts_with(kCell);
    if (skipped_.attempt([&] { read_line(line); })) return;
    if (was_inside) log_.scans.back().readings.pop_back();
    is_inside_ = false;
  }

  void read_line(std::string_view line) {
    if (line.find(kCompleted) != std::string_view::npos && !line.starts_with("ESSID")) return start_scan();
    if (line.starts_with(kCell) && line.find(kAddress) != std::string_view::npos) return start_cell(line);
    if (!is_inside_) return name_unless_known(line);
    if (const auto frequency = value_behind(line, kFrequencyName)) read_frequency(*frequency);
    if (const auto channel = value_behind(line, kChannelName)) read_channel(*channel);
    if (line.starts_with(kQualityName) || line.starts_with(kLevelName)) read_level(line);
    if (const auto extra = value_behind(line, kExtra.substr(0, kExtra.size() - 1))) read_extra(*extra);
  }

  /// Lines at the margin that belong neither to a cell nor to iwlist's own messages.
  void name_unless_known(std::string_view line) {
    const bool is_known = line.find("Interface doesn't support") != std::string_view::npos ||
                          line.find("No scan results") != std::string_view::npos;
    if (!is_known && !lines_.line().starts_with(' ')) foreign_.add(lines_);
  }

  void start_scan() {
    log_.scans.push_back(begun_.value_or(ScanList{lines_.number(), std::nullopt, {}, {}}));
    is_inside_ = false;
  }

  bool is_of_another_time() const {
    const ScanList& last = log_.scans.back();
    return begun_ && (last.stamp != begun_->stamp || last.unread_time != begun_->unread_time);
  }

  void start_cell(std::string_view line) {
    is_inside_ = false;
    const std::string_view address = trim(line.substr(line.find(kAddress) + kAddress.size()));
    const auto bssid = parse_bssid(address);
    if (!bssid && is_torn()) return;
    if (!bssid) lines_.fail(quoted_bytes(address) + " is not a valid address of a cell");
    if (log_.scans.empty() || is_of_another_time()) start_scan();
    log_.scans.back().readings.emplace_back().bssid = *bssid;
    is_inside_ = true;
  }

  void read_frequency(std::string_view text) {
    const auto mhz = parse_frequency_mhz(text);
    if (mhz)
      cell().frequency_mhz = *mhz;
    else if (!is_torn())
      lines_.fail(quoted_bytes(text) + " is not a valid frequency");
  }

  /// Some drivers report only the channel.
  void read_channel(std::string_view text) {
    const auto channel = parse_integer(text);
    if (!channel && !is_torn()) lines_.fail(quoted_bytes(text) + " is not a valid channel");
    const auto carrier_hz = channel && !is_torn() ? carrier_of_channel_hz(*channel) : std::nullopt;
    if (carrier_hz && cell().frequency_mhz == 0) cell().frequency_mhz = *carrier_hz / kHzPerMhz;
  }

  /// "Quality=58/70  Signal level=-52 dBm  Noise level=-95 dBm"
  void read_level(std::string_view line) {
    const std::size_t at = line.find(kLevelName);
    const auto value =
        at == std::string_view::npos ? std::nullopt : value_behind(line.substr(at), kLevelName);
    if (!value) return;
    const auto [level, unit] = leading_number(*value);
    if (!level && !is_torn()) lines_.fail(quoted_bytes(*value) + " is not a valid level");
    if (!unit.starts_with("dBm")) return;
    cell().rssi_dbm = level;
    if (level && line[at + kLevelName.size()] == ':') ++log_.counts[kOldLevels];
  }

  /// "Last beacon: 120ms ago"
  void read_extra(std::string_view extra) {
    if (!extra.starts_with(kBeacon)) return;
    const auto [age_ms, unit] = leading_number(trim(extra.substr(kBeacon.size())));
    const double age_s = age_ms.value_or(-1) * kSecondsPerMillisecond;
    if (unit.starts_with("ms") && age_s >= 0 && age_s <= kOldestBeacon_s)
      cell().age_s = age_s;
    else if (!is_torn())
      lines_.fail(quoted_bytes(extra) + " is not a valid age of a beacon");
  }

  TextLines lines_;
  ScanListLog log_;
  SkippedRecords skipped_;
  ForeignLines foreign_;
  std::optional<ScanList> begun_;  ///< an empty list with the time of the last line that is one
  bool is_inside_ = false;
};

}  // namespace

ScanListLog read_iwlist_scans(const Text& text) {
  ScanListLog log = IwlistReader(text).read(text.name);
  if (log.readings() == 0) text.fail(0, "contains no cell of an iwlist scan");
  return log;
}

}  // namespace radioslam
