// AoA profiles over azimuth (Bartlett, MUSIC) of a synthetic array, and their peaks.
#pragma once

#include <vector>

#include "radioslam/radio/aoa/aoa_array.hpp"
#include "radioslam/radio/aoa/multipath_model.hpp"

namespace radioslam {

/// A profile over azimuth from -pi, and the best source at each azimuth.
struct AzimuthProfile {
  std::vector<double> power;  ///< Bartlett: fraction of the channel's power explained; MUSIC: 1 / (1 - fit)
  std::vector<WaveSource> source;
};

/// Bartlett profile: mean over the subarrays of the fraction of power that a wave explains.
AzimuthProfile bartlett_profile(const MovedArray& moved, const AoaParams& params);

/// MUSIC profile: 1 / (1 - |E_s^H a|^2 / K), E_s the channel's singular vectors over the snapshots; their
/// number by minimum description length (Wax and Kailath, 1985). Paths must differ in delay: only the phases
/// over the subcarriers make the channel's rank larger than one.
AzimuthProfile music_profile(const MovedArray& moved, const AoaParams& params);

/// The strongest peaks of a profile, refined on the subarrays' channel, which also gives their sigma.
std::vector<AoaPeak> find_peaks(const AzimuthProfile& profile, const MovedArray& moved,
                                const AoaParams& params);

/// The waves of a multipath model as peaks; waves closer to each other than the array resolves are merged.
std::vector<AoaPeak> peaks_of_waves(const std::vector<WavePath>& waves, const MovedArray& one_way,
                                    const AoaParams& params);

/// Marks cross terms: peaks of the two-way product at which the one-way channel has no wave, but two waves
/// have their product. A peak that explains more than half of the channel is never marked.
void mark_cross_terms(std::vector<AoaPeak>& peaks, const std::vector<WavePath>& waves,
                      const MovedArray& one_way);

}  // namespace radioslam
