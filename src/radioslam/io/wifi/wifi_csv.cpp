#include "radioslam/io/wifi/wifi_csv.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <tuple>
#include <unordered_map>

#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr double kWeakest_dbm = -150;
constexpr double kStrongest_dbm = 30;

/// Assigns numbers to BSSIDs; a recording repeats few of them very often.
class BssidNumbers {
 public:
  /// Accepts any capitalisation; equal in lower case means the same BSSID.
  std::uint32_t of(std::string_view spelling) {
    const auto known = by_spelling_.find(spelling);
    if (known != by_spelling_.end()) return known->second;
    const std::string lower = lower_case(spelling);
    const auto [place, is_new] = by_spelling_.try_emplace(lower, static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(lower);
    const std::uint32_t number = place->second;
    by_spelling_.emplace(spelling, number);
    return number;
  }

  std::vector<std::string> sorted() const {
    std::vector<std::string> names = names_;
    std::sort(names.begin(), names.end());
    return names;
  }

  /// Per number, the position in the sorted list.
  std::vector<AccessPointIndex> places(const std::vector<std::string>& sorted) const {
    std::vector<AccessPointIndex> places;
    for (const auto& name : names_) {
      const auto place = std::lower_bound(sorted.begin(), sorted.end(), name);
      places.emplace_back(static_cast<std::size_t>(place - sorted.begin()));
    }
    return places;
  }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view s) const { return std::hash<std::string_view>()(s); }
  };

  std::unordered_map<std::string, std::uint32_t, Hash, std::equal_to<>> by_spelling_;
  std::vector<std::string> names_;  ///< in lower case, by number
};

struct Row {
  Stamp stamp;
  std::uint32_t bssid = 0;  ///< number of the BSSID
  float frequency_mhz = 0;
  float rssi_dbm = 0;
};

/// Cache of the last stamp and its text, because the rows of a scan share them.
struct LastStamp {
  std::string_view text;
  Stamp stamp;
};

Row read_row(const CsvReader& csv, LastStamp& last, BssidNumbers& numbers) {
  enum : std::size_t { kTime, kBssid, kFrequency, kRssi };
  if (csv.field(kTime) != last.text || last.text.empty()) last = {csv.field(kTime), csv.stamp(kTime)};
  const std::string_view bssid = csv.field(kBssid);
  if (bssid.empty()) csv.fail("the bssid is empty");
  const double frequency_mhz = csv.coordinate(kFrequency);
  if (frequency_mhz < 0) csv.fail("the frequency is negative");
  const double rssi_dbm = csv.number(kRssi);
  if (!is_plausible_rssi(rssi_dbm))
    csv.fail("rssi_dbm " + format_number(rssi_dbm) + " is outside -150 to 30 dBm");
  return {last.stamp, numbers.of(bssid), static_cast<float>(frequency_mhz), static_cast<float>(rssi_dbm)};
}

std::vector<Row> read_rows(const Text& text, BssidNumbers& numbers) {
  CsvReader csv(text, {{"t_s", "bssid", "frequency_mhz", "rssi_dbm"}});
  std::vector<Row> rows;
  LastStamp last;
  while (csv.next()) rows.push_back(read_row(csv, last, numbers));
  return rows;
}

/// Order by stamp and access point; the strongest reading comes first among equals, so that the result does
/// not depend on the order of the rows.
void sort_rows(std::vector<Row>& rows, const std::vector<AccessPointIndex>& places) {
  const auto before = [&](const Row& a, const Row& b) {
    return std::tie(a.stamp, places[a.bssid], b.rssi_dbm, b.frequency_mhz) <
           std::tie(b.stamp, places[b.bssid], a.rssi_dbm, a.frequency_mhz);
  };
  if (!std::is_sorted(rows.begin(), rows.end(), before)) std::sort(rows.begin(), rows.end(), before);
  const auto same = [](const Row& a, const Row& b) { return a.stamp == b.stamp && a.bssid == b.bssid; };
  rows.erase(std::unique(rows.begin(), rows.end(), same), rows.end());
}

std::vector<WifiScan> scans_of(const std::vector<Row>& rows, const std::vector<AccessPointIndex>& places) {
  std::vector<WifiScan> scans;
  for (const Row& row : rows) {
    if (scans.empty() || scans.back().stamp != row.stamp) scans.push_back({row.stamp, {}});
    scans.back().readings.push_back({places[row.bssid], row.frequency_mhz, row.rssi_dbm});
  }
  return scans;
}

}  // namespace

bool is_plausible_rssi(double rssi_dbm) { return rssi_dbm >= kWeakest_dbm && rssi_dbm <= kStrongest_dbm; }

WifiRecordings read_wifi(std::span<const Text> texts) {
  BssidNumbers numbers;
  std::vector<std::vector<Row>> receivers;
  for (const Text& text : texts) receivers.push_back(read_rows(text, numbers));
  WifiRecordings result;
  result.access_points = numbers.sorted();
  const std::vector<AccessPointIndex> places = numbers.places(result.access_points);
  for (auto& rows : receivers) {
    sort_rows(rows, places);
    result.receivers.push_back(scans_of(rows, places));
  }
  return result;
}

std::string format_wifi(const std::vector<WifiScan>& scans, const std::vector<std::string>& access_points) {
  std::string out = "t_s,bssid,frequency_mhz,rssi_dbm\n";
  for (const WifiScan& scan : scans) {
    const std::string start = format_stamp(scan.stamp) + ",";
    for (const WifiReading& reading : scan.readings) {
      (out += start) += access_points[reading.access_point.index()];
      append_number(out += ',', reading.frequency_mhz);
      append_number(out += ',', reading.rssi_dbm);
      out += '\n';
    }
  }
  return out;
}

}  // namespace radioslam
