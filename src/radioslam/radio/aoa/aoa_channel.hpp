// Channels that an AoA estimate works on: one-way channel, two-way product, or difference of an antenna pair.
#pragma once

#include "radioslam/radio/aoa/aoa_array.hpp"

namespace radioslam {

/// The track's packets between two stamps. Of a two-way product the packets' delays are aligned with those
/// before and the square root is taken; the difference of an antenna pair is copied unchanged.
ChannelTrack one_way_channel(const ChannelTrack& track, Stamp begin, Stamp end);

/// Two-way product of a one-way channel, normalised to unit amplitude: faded values weigh as much as others.
MovedArray two_way_product(const MovedArray& one_way);

/// An antenna pair's channel, normalised to unit amplitude.
MovedArray amplitude_equalised(const MovedArray& difference);

}  // namespace radioslam
