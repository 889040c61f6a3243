#include "radioslam/io/csi/csi_band.hpp"

namespace radioslam {

std::vector<int> subcarriers_on_both_sides(int nearest, int furthest) {
  std::vector<int> numbers;
  for (int k = -furthest; k <= -nearest; ++k) numbers.push_back(k);
  for (int k = nearest; k <= furthest; ++k) numbers.push_back(k);
  return numbers;
}

CsiCapture capture_of(const CapturedBand& band) {
  CsiCapture capture;
  capture.carrier_hz = band.carrier_hz;
  capture.bandwidth_hz = band.bandwidth_hz;
  for (const int k : band.subcarriers) capture.subcarrier_hz.push_back(k * kSubcarrierSpacing_hz);
  return capture;
}

}  // namespace radioslam
