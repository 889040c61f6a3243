// Frequencies of a captured channel's subcarriers.
#pragma once

#include <compare>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Subcarrier spacing of 802.11a, g, n and ac.
inline constexpr double kSubcarrierSpacing_hz = 312.5e3;

/// The subcarriers that a packet was measured on, numbered from the carrier.
struct CapturedBand {
  double carrier_hz = 0;
  double bandwidth_hz = 0;
  std::vector<int> subcarriers;
  friend auto operator<=>(const CapturedBand&, const CapturedBand&) = default;
};

/// The subcarriers from -furthest to -nearest and from nearest to furthest.
std::vector<int> subcarriers_on_both_sides(int nearest, int furthest);

/// An empty capture with the frequencies of this band.
CsiCapture capture_of(const CapturedBand& band);

}  // namespace radioslam
