// Packet delay alignment: removes each packet's own delay from the one-way channel by alternating between
// fitting a multipath model and aligning every packet to it, with more waves in each round.
#pragma once

#include <vector>

#include "radioslam/radio/aoa/aoa_array.hpp"
#include "radioslam/radio/aoa/multipath_model.hpp"

namespace radioslam {

/// Azimuths of the grid on which waves are searched.
inline constexpr int kWaveAzimuths = 240;

/// Aligns the rows of the array's channel; returns the waves, the strongest at a delay of about zero.
std::vector<WavePath> align_delays(MovedArray& one_way, const AoaParams& params);

/// Delays at which waves are searched: up to 2.5 resolutions of the band, in steps of an eighth.
DelayTable delay_table(const std::vector<double>& subcarrier_hz);

/// Delays by which packets may differ: up to 5 resolutions of the band, in steps of an eighth.
DelayTable packet_delays(const std::vector<double>& subcarrier_hz);

}  // namespace radioslam
