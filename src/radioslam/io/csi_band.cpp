#include "radioslam/io/csi_band.hpp"

namespace radioslam {
namespace {

constexpr double kMegahertz = 1e6, kChannelStep_mhz = 5;
constexpr double kChannel0At2_mhz = 2407, kChannel14_mhz = 2484, kChannel0At5_mhz = 5000;
constexpr int kLastRegularChannelAt2 = 13, kFirstChannelAt5 = 32, kLastChannelAt5 = 177;

}  // namespace

std::optional<double> carrier_at_2_ghz(int channel) {
  if (channel == kLastRegularChannelAt2 + 1) return kChannel14_mhz * kMegahertz;
  if (channel < 1 || channel > kLastRegularChannelAt2) return std::nullopt;
  return (kChannel0At2_mhz + kChannelStep_mhz * channel) * kMegahertz;
}

std::optional<double> carrier_at_5_ghz(int channel) {
  if (channel < kFirstChannelAt5 || channel > kLastChannelAt5) return std::nullopt;
  return (kChannel0At5_mhz + kChannelStep_mhz * channel) * kMegahertz;
}

std::vector<int> subcarriers_on_both_sides(int nearest, int furthest) {
  std::vector<int> numbers;
  for (int k = -furthest; k <= -nearest; ++k) numbers.push_back(k);
  for (int k = nearest; k <= furthest; ++k) numbers.push_back(k);
  return numbers;
}

CsiCapture capture_of(const CsiBand& band) {
  CsiCapture capture;
  capture.carrier_hz = band.carrier_hz;
  capture.bandwidth_hz = band.bandwidth_hz;
  for (const int k : band.subcarriers) capture.subcarrier_hz.push_back(k * kSubcarrierSpacing_hz);
  return capture;
}

}  // namespace radioslam
