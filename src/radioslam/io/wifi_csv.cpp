#include "radioslam/io/wifi_csv.hpp"

#include <algorithm>
#include <tuple>

#include "radioslam/io/csv.hpp"
#include "radioslam/io/numbers.hpp"

namespace radioslam {
namespace {

constexpr double kWeakest_dbm = -150;
constexpr double kStrongest_dbm = 30;

struct Row {
  Stamp stamp;
  std::string bssid;
  float frequency_mhz = 0;
  float rssi_dbm = 0;
};

Row read_row(const CsvReader& csv) {
  enum : std::size_t { kTime, kBssid, kFrequency, kRssi };
  const Stamp stamp = csv.stamp(kTime);
  const std::string_view bssid = csv.field(kBssid);
  if (bssid.empty()) csv.fail("the bssid is empty");
  const double frequency_mhz = csv.coordinate(kFrequency);
  if (frequency_mhz < 0) csv.fail("the frequency is negative");
  const double rssi_dbm = csv.number(kRssi);
  if (!is_plausible_rssi(rssi_dbm))
    csv.fail("rssi_dbm " + format_number(rssi_dbm) + " is outside -150 to 30 dBm");
  return {stamp, lower_case(bssid), static_cast<float>(frequency_mhz), static_cast<float>(rssi_dbm)};
}

std::vector<Row> read_rows(const Text& text) {
  CsvReader csv(text, {{"t_s", "bssid", "frequency_mhz", "rssi_dbm"}});
  std::vector<Row> rows;
  while (csv.next()) rows.push_back(read_row(csv));
  // The strongest first among equals, so that the order of the rows does not matter.
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return std::tie(a.stamp, a.bssid, b.rssi_dbm, b.frequency_mhz) <
           std::tie(b.stamp, b.bssid, a.rssi_dbm, a.frequency_mhz);
  });
  const auto same = [](const Row& a, const Row& b) { return a.stamp == b.stamp && a.bssid == b.bssid; };
  rows.erase(std::unique(rows.begin(), rows.end(), same), rows.end());
  return rows;
}

std::vector<std::string> distinct_bssids(const std::vector<std::vector<Row>>& receivers) {
  std::vector<std::string> result;
  for (const auto& rows : receivers)
    for (const Row& row : rows) result.push_back(row.bssid);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<WifiScan> scans_of(const std::vector<Row>& rows, const std::vector<std::string>& access_points) {
  std::vector<WifiScan> scans;
  for (const Row& row : rows) {
    if (scans.empty() || scans.back().stamp != row.stamp) scans.push_back({row.stamp, {}});
    const auto place = std::lower_bound(access_points.begin(), access_points.end(), row.bssid);
    const auto index = static_cast<std::size_t>(place - access_points.begin());
    scans.back().readings.push_back({AccessPointIndex(index), row.frequency_mhz, row.rssi_dbm});
  }
  return scans;
}

}  // namespace

bool is_plausible_rssi(double rssi_dbm) { return rssi_dbm >= kWeakest_dbm && rssi_dbm <= kStrongest_dbm; }

WifiRecordings read_wifi(std::span<const Text> texts) {
  std::vector<std::vector<Row>> receivers;
  for (const Text& text : texts) receivers.push_back(read_rows(text));
  WifiRecordings result;
  result.access_points = distinct_bssids(receivers);
  for (const auto& rows : receivers) result.receivers.push_back(scans_of(rows, result.access_points));
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
