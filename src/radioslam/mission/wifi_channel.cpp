#include "radioslam/mission/wifi_channel.hpp"

#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

constexpr double kChannelStep_hz = 5 * kHzPerMhz;
constexpr double kSubcarrierSpacing_hz = 312.5e3;
constexpr std::int64_t kLastOf2GHz = 14, kFirstOf5GHz = 32, kLastOf5GHz = 177;

}  // namespace

std::optional<double> carrier_of_channel_hz(std::int64_t channel) {
  const auto above = [&](double base_mhz) {
    return base_mhz * kHzPerMhz + static_cast<double>(channel) * kChannelStep_hz;
  };
  if (channel >= 1 && channel < kLastOf2GHz) return above(2407);
  if (channel == kLastOf2GHz) return 2484 * kHzPerMhz;
  if (channel >= kFirstOf5GHz && channel <= kLastOf5GHz) return above(5000);
  return std::nullopt;
}

double megahertz(double frequency) {
  constexpr double kMostGhz = 100, kMostMhz = 1e5, kMostKhz = 1e8;
  if (!(frequency > 0)) return 0;
  if (frequency < kMostGhz) return frequency * 1e3;
  if (frequency < kMostMhz) return frequency;
  return frequency / (frequency < kMostKhz ? 1e3 : 1e6);
}

std::optional<std::int64_t> channel_of_carrier(double carrier_hz) {
  for (std::int64_t channel = 1; channel <= kLastOf5GHz; ++channel)
    if (carrier_of_channel_hz(channel) == carrier_hz) return channel;
  return std::nullopt;
}

std::vector<double> grouped_subcarriers_hz(ChannelWidth width) {
  std::vector<double> hz;
  const auto add = [&](int index) { hz.push_back(index * kSubcarrierSpacing_hz); };
  if (width == ChannelWidth::k40MHz) {
    for (int k = -58; k <= 58; k += 4) add(k);
    return hz;
  }
  for (int k = -28; k <= -2; k += 2) add(k);
  add(-1);
  for (int k = 1; k <= 27; k += 2) add(k);
  add(28);
  return hz;
}

}  // namespace radioslam
