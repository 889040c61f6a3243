// Where in the spectrum the columns of a channel lie.
#pragma once

#include <compare>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Of 802.11a, g, n and ac.
inline constexpr double kSubcarrierSpacing_hz = 312.5e3;

/// The columns that a packet measured, by their subcarriers' numbers from the carrier.
struct CapturedBand {
  double carrier_hz = 0;
  double bandwidth_hz = 0;
  std::vector<int> subcarriers;
  friend auto operator<=>(const CapturedBand&, const CapturedBand&) = default;
};

/// From -furthest to -nearest and from nearest to furthest.
std::vector<int> subcarriers_on_both_sides(int nearest, int furthest);

/// A capture without packets whose columns lie there.
CsiCapture capture_of(const CapturedBand& band);

}  // namespace radioslam
