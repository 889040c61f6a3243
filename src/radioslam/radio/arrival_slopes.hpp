// Each packet's own delay, taken off against the few waves that explain the channel of one way: the waves
// are found, each packet is aligned with what they make of it, and again with more of them.
#pragma once

#include <vector>

#include "radioslam/radio/arrival_array.hpp"
#include "radioslam/radio/path_model.hpp"

namespace radioslam {

/// Of the grid that waves are sought on.
inline constexpr int kWaveAzimuths = 240;

/// Aligns the rows of the array's channel; returns the waves, the strongest at about no delay.
std::vector<WavePath> align_to_waves(MovedArray& one_way, const ArrivalParams& params);

/// The delays in which waves are sought: twice the resolution of the band, at an eighth of it.
DelayTable delay_table(const std::vector<double>& subcarrier_hz);

/// The delays by which packets may differ.
DelayTable packet_delays(const std::vector<double>& subcarrier_hz);

}  // namespace radioslam
