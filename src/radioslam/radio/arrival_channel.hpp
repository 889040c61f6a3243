// The channel that an estimate works on: of one way, of both ways again, or of a pair of antennas.
#pragma once

#include "radioslam/radio/arrival_array.hpp"

namespace radioslam {

/// The track's packets between two stamps. A product both ways is aligned with its predecessors and its
/// square root taken; the difference of a pair of antennas stays as it is.
ChannelTrack one_way_between(const ChannelTrack& track, Stamp begin, Stamp end);

/// The product both ways again, every value as strong as the next: what is faded counts as what is not.
MovedArray both_ways(const MovedArray& one_way);

/// A pair's channel, every value as strong as the next.
MovedArray evened(const MovedArray& difference);

}  // namespace radioslam
