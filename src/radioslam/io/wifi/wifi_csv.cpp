#include "radioslam/io/wifi/wifi_csv.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr double kWeakest_dbm = -150;
constexpr double kStrongest_dbm = 30;

/// Assigns numbers to BSSIDs as they are spelled; a recording repeats few of them very often.
class BssidSpellings {
 public:
  std::uint32_t of(std::string_view spelling) {
    const auto known = numbers_.find(spelling);
    if (known != numbers_.end()) return known->second;
    spellings_.emplace_back(spelling);
    return numbers_.emplace(spelling, static_cast<std::uint32_t>(spellings_.size() - 1)).first->second;
  }

  const std::vector<std::string>& by_number() const { return spellings_; }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view s) const { return std::hash<std::string_view>()(s); }
  };

  std::unordered_map<std::string, std::uint32_t, Hash, std::equal_to<>> numbers_;
  std::vector<std::string> spellings_;
};

/// The BSSIDs that the spellings mean.
struct Bssids {
  std::vector<std::string> sorted;
  std::vector<AccessPointIndex> places;     ///< per spelling, the position in the sorted list
  std::vector<std::size_t> spelling_count;  ///< per BSSID

  explicit Bssids(const std::vector<std::string>& spellings) {
    std::vector<std::string> names;
    for (const auto& spelling : spellings) names.push_back(canonical_bssid(spelling));
    sorted = names;
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    spelling_count.resize(sorted.size());
    for (const auto& name : names) {
      places.emplace_back(
          static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), name) - sorted.begin()));
      ++spelling_count[places.back().index()];
    }
  }
};

struct Row {
  Stamp stamp;
  std::uint32_t bssid = 0;  ///< number of its spelling
  float frequency_mhz = 0;
  float rssi_dbm = 0;
};

/// Cache of the last stamp and its text, because the rows of a scan share them.
struct LastStamp {
  std::string_view text;
  Stamp stamp;
};

Row read_row(const CsvReader& csv, LastStamp& last, BssidSpellings& spellings) {
  enum : std::size_t { kTime, kBssid, kFrequency, kRssi };
  if (csv.field(kTime) != last.text || last.text.empty()) last = {csv.field(kTime), csv.stamp(kTime)};
  const std::string_view bssid = csv.field(kBssid);
  if (bssid.empty()) csv.fail("the bssid is empty");
  if (!is_plain_text(bssid)) csv.fail("the bssid has control characters or is not UTF-8");
  constexpr auto kUnit = InputError::Kind::kUnit;
  const double frequency_mhz = coordinate_in(csv.at(), csv.field(kFrequency), "frequency_mhz", kUnit);
  if (frequency_mhz < 0) csv.fail("the frequency is negative", kUnit);
  const double rssi_dbm = number_in(csv.at(), csv.field(kRssi), "rssi_dbm", kUnit);
  if (!is_plausible_rssi(rssi_dbm))
    csv.fail("rssi_dbm " + format_number(rssi_dbm) + " is outside -150 to 30 dBm", kUnit);
  return {last.stamp, spellings.of(bssid), static_cast<float>(frequency_mhz), static_cast<float>(rssi_dbm)};
}

std::vector<Row> read_rows(const Text& text, BssidSpellings& spellings) {
  CsvReader csv(text, {{"t_s", "bssid", "frequency_mhz", "rssi_dbm"}});
  std::vector<Row> rows;
  LastStamp last;
  while (csv.next()) rows.push_back(read_row(csv, last, spellings));
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
  const auto same = [&](const Row& a, const Row& b) {
    return a.stamp == b.stamp && places[a.bssid] == places[b.bssid];
  };
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

/// What one receiver spells otherwise than another row of any receiver does.
Respelled respelled_in(const std::vector<Row>& rows, const std::vector<std::string>& spellings,
                       const Bssids& bssids) {
  std::vector<bool> is_used(spellings.size());
  for (const Row& row : rows) is_used[row.bssid] = true;
  Respelled respelled;
  for (std::size_t k = 0; k < spellings.size(); ++k) {
    const std::size_t bssid = bssids.places[k].index();
    if (!is_used[k] || bssids.spelling_count[bssid] < 2 || spellings[k] == bssids.sorted[bssid]) continue;
    if (++respelled.count == 1) respelled.example = spellings[k];
  }
  return respelled;
}

}  // namespace

bool is_plausible_rssi(double rssi_dbm) { return rssi_dbm >= kWeakest_dbm && rssi_dbm <= kStrongest_dbm; }

WifiRecordings read_wifi(std::span<const Text> texts) {
  BssidSpellings spellings;
  std::vector<std::vector<Row>> receivers;
  for (const Text& text : texts) receivers.push_back(read_rows(text, spellings));
  Bssids bssids(spellings.by_number());
  WifiRecordings result;
  for (auto& rows : receivers) {
    result.respelled.push_back(respelled_in(rows, spellings.by_number(), bssids));
    sort_rows(rows, bssids.places);
    result.receivers.push_back(scans_of(rows, bssids.places));
  }
  result.access_points = std::move(bssids.sorted);
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
