#include "radioslam/io/wifi/scan_table.hpp"

#include <algorithm>
#include <set>

#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/named_columns.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

constexpr const char* kBssidNames = "(?:.*_)?bs?sid";
constexpr const char* kAddressNames = "(?:ap_|wifi_)?(?:mac|(?:mac_?)?addr(?:ess)?)";
constexpr const char* kLevelNames =
    "(?:wifi_|ap_|mean_)?(?:rssi|rss|level|dbm|signal(?:_?(?:strength|level))?)(?:_?dbm?)?";
constexpr const char* kFrequencyNames = "(?:.*_)?(?:freq|frequency)(?:_?[kmg]?hz)?";
constexpr const char* kChannelNames = "(?:.*_)?channel(?:_?num(?:ber)?)?";
constexpr std::string_view kWigleMark = "WigleWifi-";
/// What Android gives to apps without the permission to see addresses.
constexpr std::string_view kPlaceholder = "02:00:00:00:00:00";

constexpr const char* kOtherRadios = "rows are of other radios than WiFi and left out";
constexpr const char* kPlaceholders =
    "readings have Android's placeholder 02:00:00:00:00:00 for an address and are left out: the app lacked a "
    "permission";
constexpr const char* kNotNegative = "levels are not negative, so not in dBm, and left out";
constexpr const char* kNoZone =
    "times have no known time zone and are taken as UTC; --set scans.clock_offset_s=SECONDS corrects them";

/// The table with commas, and with WiGLE's first line as a comment.
Text readable(const Text& text) {
  Text table = text;
  if (table.content.starts_with(kWigleMark)) table.content.front() = '#';
  return with_commas(std::move(table));
}

struct ScanColumns {
  std::size_t time = 0, bssid = 0, level = 0;
  std::string time_name;
  std::optional<std::size_t> frequency, channel, type;

  static std::optional<ScanColumns> find(const CsvReader& csv) {
    const NamedColumns names(csv);
    const auto time = names.find_time(), level = names.find(kLevelNames);
    auto bssid = names.find(kBssidNames);
    if (!bssid) bssid = names.find(kAddressNames);
    if (!time || !bssid || !level) return std::nullopt;
    return ScanColumns{*time,
                       *bssid,
                       *level,
                       names.name(*time),
                       names.find(kFrequencyNames),
                       names.find(kChannelNames),
                       names.find("type")};
  }
};

/// Reads one table.
class ScanTableReader {
 public:
  explicit ScanTableReader(const Text& table, double clock_offset_s)
      : csv_(table), clock_offset_s_(clock_offset_s) {}

  WifiLog read(const Text& text) {
    const auto columns = ScanColumns::find(csv_);
    if (!columns) csv_.fail("has no columns of a time, a BSSID and a level", InputError::Kind::kColumnOrder);
    columns_ = *columns;
    bool is_row = true;
    while (is_row)
      skipped_.attempt([&] {
        is_row = csv_.next();
        if (is_row) read_row();
      });
    skipped_.conclude(text.name, "row", log_.rows.size(), log_.warnings);
    if (const auto note = control_character_note(text)) log_.warnings.push_back(*note);
    return std::move(log_);
  }

 private:
  void read_row() {
    if (columns_.type && lower_case(csv_.field(*columns_.type)) != "wifi" && csv_.given(*columns_.type))
      return void(++log_.counts[kOtherRadios]);
    const ReadTime time = time_in(csv_, columns_.time, columns_.time_name);
    const std::string bssid = canonical_bssid(csv_.field(columns_.bssid));
    if (!parse_bssid(bssid)) csv_.fail(quoted_bytes(csv_.field(columns_.bssid)) + " is not a valid address");
    const double level_dbm = csv_.number(columns_.level);
    if (bssid == kPlaceholder) return void(++log_.counts[kPlaceholders]);
    if (level_dbm >= 0) return void(++log_.counts[kNotNegative]);
    if (!time.zone_known) ++log_.counts[kNoZone];
    log_.rows.push_back({on_clock_ahead_by(clock_offset_s_, time.stamp), bssid,
                         static_cast<float>(frequency_mhz()), static_cast<float>(level_dbm)});
  }

  /// 0 if it is unknown.
  double frequency_mhz() const {
    const auto value = columns_.frequency ? parse_number(csv_.field(*columns_.frequency)) : std::nullopt;
    if (value && *value > 0) return megahertz(*value);
    const auto channel = columns_.channel ? parse_integer(csv_.field(*columns_.channel)) : std::nullopt;
    const auto carrier_hz = channel ? carrier_of_channel_hz(*channel) : std::nullopt;
    return carrier_hz ? megahertz(*carrier_hz) : 0;
  }

  CsvReader csv_;
  double clock_offset_s_;
  ScanColumns columns_;
  WifiLog log_;
  SkippedRecords skipped_;
};

/// Gives the rows of a scan the time of its first one.
void group_scans(std::vector<WifiRow>& rows, double scan_s) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const WifiRow& a, const WifiRow& b) { return a.stamp < b.stamp; });
  Stamp begin;
  std::set<std::string> addresses;
  for (WifiRow& row : rows) {
    const bool is_within = !addresses.empty() && seconds_between(begin, row.stamp) <= scan_s;
    if (!is_within || addresses.contains(row.bssid)) {
      begin = row.stamp;
      addresses.clear();
    }
    addresses.insert(row.bssid);
    row.stamp = begin;
  }
}

}  // namespace

bool is_scan_table(const Text& text) {
  const Text table = readable(text);
  try {
    const CsvReader csv(table);
    return ScanColumns::find(csv).has_value();
  } catch (const InputError&) {  // without a header
    return false;
  }
}

WifiLog read_scan_table(const Text& text, const ScanTableParams& params) {
  const Text table = readable(text);
  WifiLog log = ScanTableReader(table, params.clock_offset_s).read(text);
  group_scans(log.rows, params.scan_s);
  return log;
}

}  // namespace radioslam
