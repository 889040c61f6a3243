#include "radioslam/radio/channel/capture_power.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/radio/channel/effective_snr.hpp"
#include "radioslam/radio/channel/intel5300_power.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxPackets = 200;

struct NamedModulation {
  const char* name;
  Modulation modulation;
};

constexpr std::array<NamedModulation, 4> kModulations{{{"bpsk", Modulation::kBpsk},
                                                       {"qpsk", Modulation::kQpsk},
                                                       {"qam16", Modulation::kQam16},
                                                       {"qam64", Modulation::kQam64}}};

std::optional<double> middle_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  return upper_median(std::move(values));
}

bool is_in_dbm(const CsiPacket& packet) {
  return std::any_of(packet.rssi.begin(), packet.rssi.end(), [](int rssi) { return rssi < 0; });
}

std::optional<double> power_dbm(const CsiPacket& packet) {
  if (!is_in_dbm(packet)) return received_power_dbm(packet);
  double sum_mw = 0;
  for (const int rssi : packet.rssi)
    if (rssi != 0) sum_mw += std::pow(10, rssi / 10.0);
  return decibels(sum_mw);
}

}  // namespace

CapturePower capture_power(const CsiCapture& capture, std::optional<MacAddress> sender) {
  std::vector<const CsiPacket*> packets;
  for (const CsiPacket& packet : capture.packets)
    if (!sender || packet.sender == sender) packets.push_back(&packet);
  std::vector<double> powers_dbm;
  std::array<std::vector<double>, kModulations.size()> snrs_db;
  const std::size_t counted = std::min(packets.size(), kMaxPackets);
  for (std::size_t k = 0; k < counted; ++k) {
    const CsiPacket& packet = *packets[k * packets.size() / counted];
    if (const auto power = power_dbm(packet)) powers_dbm.push_back(*power);
    if (is_in_dbm(packet)) continue;
    const auto subcarriers_db = subcarrier_snr_db(packet);
    if (!subcarriers_db) continue;
    for (std::size_t m = 0; m < kModulations.size(); ++m)
      snrs_db[m].push_back(effective_snr_db(*subcarriers_db, kModulations[m].modulation));
  }
  CapturePower power{packets.size(), middle_of(std::move(powers_dbm)), {}};
  for (std::size_t m = 0; m < kModulations.size(); ++m)
    if (const auto snr_db = middle_of(std::move(snrs_db[m])))
      power.effective_snr_db.emplace_back(kModulations[m].name, *snr_db);
  return power;
}

}  // namespace radioslam
