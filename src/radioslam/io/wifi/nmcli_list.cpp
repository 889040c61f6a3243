#include "radioslam/io/wifi/nmcli_list.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/wifi/log_time.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

constexpr int kFullSignal = 100;
constexpr int kStrongestLevel_dbm = -40, kLevels_db = 60;
constexpr double kHighestCarrier_mhz = 1e6;
constexpr std::string_view kMhzUnit = " MHz";
constexpr const char* kInexact =
    "values of SIGNAL do not correspond to a whole dBm; the nearest level is used";
constexpr const char* kClipped = "values of SIGNAL are 0 or 100: -100 dBm or weaker, -40 dBm or stronger";

/// NetworkManager's conversion of whole dB below -40 dBm to SIGNAL.
int nmcli_signal_of(int below_db) { return kFullSignal - kFullSignal * below_db / kLevels_db; }

/// Positions of the fields that are read.
struct NmcliColumns {
  explicit NmcliColumns(const std::vector<std::string>& fields) : count(fields.size()) {
    const auto find = [&](const char* name) -> std::optional<std::size_t> {
      const auto place = std::find(fields.begin(), fields.end(), name);
      if (place == fields.end()) return std::nullopt;
      return static_cast<std::size_t>(place - fields.begin());
    };
    bssid = *find("BSSID");
    signal = *find("SIGNAL");
    frequency = find("FREQ");
    channel = find("CHAN");
  }

  std::size_t count = 0, bssid = 0, signal = 0;
  std::optional<std::size_t> frequency, channel;
};

std::vector<std::string> split_escaped(std::string_view line) {
  std::vector<std::string> fields(1);
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == ':')
      fields.emplace_back();
    else
      fields.back() += line[k] == '\\' && k + 1 < line.size() ? line[++k] : line[k];
  }
  return fields;
}

/// One row of a list.
class NmcliRow {
 public:
  NmcliRow(const TextLines& at, const NmcliColumns& columns)
      : at_(at), columns_(columns), fields_(split_escaped(at.line())) {
    if (fields_.size() != columns.count)
      at.fail("the row has " + std::to_string(fields_.size()) + " fields, but --fields names " +
              std::to_string(columns.count));
  }

  std::string bssid() const {
    const std::string& text = fields_[columns_.bssid];
    const auto bssid = parse_bssid(text);
    if (!bssid) at_.fail(quoted_bytes(text) + " is not a valid BSSID");
    return *bssid;
  }

  int signal() const {
    const std::string& text = fields_[columns_.signal];
    const auto value = parse_integer(text);
    if (!value || *value < 0 || *value > kFullSignal)
      at_.fail(quoted_bytes(text) + " is not a SIGNAL from 0 to 100");
    return static_cast<int>(*value);
  }

  double frequency_mhz() const {
    if (!columns_.frequency) return frequency_of_channel_mhz();
    std::string_view text = fields_[*columns_.frequency];
    if (text.ends_with(kMhzUnit)) text.remove_suffix(kMhzUnit.size());
    const auto mhz = parse_number(text);
    if (!mhz || *mhz < 0 || *mhz > kHighestCarrier_mhz)
      at_.fail(quoted_bytes(text) + " is not a FREQ in MHz");
    return *mhz;
  }

 private:
  double frequency_of_channel_mhz() const {
    if (!columns_.channel) return 0;
    const auto channel = parse_integer(fields_[*columns_.channel]);
    if (!channel) at_.fail(quoted_bytes(fields_[*columns_.channel]) + " is not a valid CHAN");
    return carrier_of_channel_hz(*channel).value_or(0) / kHzPerMhz;
  }

  const TextLines& at_;
  const NmcliColumns& columns_;
  std::vector<std::string> fields_;
};

}  // namespace

std::vector<std::string> default_nmcli_fields() { return {"BSSID", "SSID-HEX", "CHAN", "FREQ", "SIGNAL"}; }

std::vector<std::string> parse_nmcli_fields(const std::string& list) {
  std::vector<std::string> names(1);
  for (const char c : list) {
    if (c == ',')
      names.emplace_back();
    else
      names.back() += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  for (const char* name : {"BSSID", "SIGNAL"})
    if (std::count(names.begin(), names.end(), name) != 1)
      throw InputError("--fields " + list, 0, std::string(name) + " must appear exactly once");
  return names;
}

NmcliLevel level_of_nmcli_signal(int signal) {
  const int missing = kFullSignal - signal;
  const int below_db = (missing * kLevels_db + kFullSignal - 1) / kFullSignal;  // rounded up
  if (nmcli_signal_of(below_db) == signal) return {static_cast<double>(kStrongestLevel_dbm - below_db), true};
  return {kStrongestLevel_dbm - static_cast<double>(missing * kLevels_db) / kFullSignal, false};
}

ScanListLog read_nmcli_lists(const Text& text, const std::vector<std::string>& fields) {
  const NmcliColumns columns(fields);
  ScanListLog log;
  TextLines lines(text);
  std::size_t rows = 0;
  while (lines.next()) {
    const auto time = parse_time_line(lines.line());
    if (time || (log.scans.empty() && !trim(lines.line()).empty()))
      log.scans.push_back({lines.number(), time, {}});
    if (time || trim(lines.line()).empty()) continue;
    const NmcliRow row(lines, columns);
    const int signal = row.signal();
    const NmcliLevel level = level_of_nmcli_signal(signal);
    if (!level.exact) ++log.counts[kInexact];
    if (signal == 0 || signal == kFullSignal) ++log.counts[kClipped];
    log.scans.back().readings.push_back({row.bssid(), row.frequency_mhz(), level.rssi_dbm, 0, std::nullopt});
    ++rows;
  }
  if (rows == 0) text.fail(0, "contains no row of an nmcli list");
  return log;
}

}  // namespace radioslam
