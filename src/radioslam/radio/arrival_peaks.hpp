// From an aligned array to its profile over azimuth and the profile's peaks.
#pragma once

#include <vector>

#include "radioslam/radio/arrival_array.hpp"
#include "radioslam/radio/path_model.hpp"

namespace radioslam {

/// A profile over azimuth from -pi, and where each azimuth's best source lies.
struct AzimuthProfile {
  std::vector<double> power;  ///< share of the channel explained, for Bartlett; 1 / (1 - fit) for MUSIC
  std::vector<WaveSource> source;
};

/// Sum over the pieces of the way of what a wave explains.
AzimuthProfile bartlett_profile(const MovedArray& moved, const ArrivalParams& params);

/// 1 / (1 - |E_s^H a|^2 / K), E_s the channel's singular vectors over the snapshots; how many of them are
/// signal by minimum description length (Wax and Kailath, 1985). It needs paths whose delays differ: over
/// the subcarriers they are what makes the channel's rank more than one.
AzimuthProfile music_profile(const MovedArray& moved, const ArrivalParams& params);

/// The strongest peaks of a profile, refined; sigma from the pieces' channel.
std::vector<ArrivalPeak> find_peaks(const AzimuthProfile& profile, const MovedArray& moved,
                                    const ArrivalParams& params);

/// The waves themselves as peaks, those nearer to each other than the array parts joined.
std::vector<ArrivalPeak> peaks_of_waves(const std::vector<WavePath>& waves, const MovedArray& one_way,
                                        const ArrivalParams& params);

/// Marks peaks of the product both ways that no wave of one way explains, but two waves' product does. What
/// explains more than half of the channel is none.
void name_ghosts(std::vector<ArrivalPeak>& peaks, const std::vector<WavePath>& waves,
                 const MovedArray& one_way);

}  // namespace radioslam
