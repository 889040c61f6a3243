// The channels between a moving antenna and another radio, out of the captures that a call of `radioslam aoa`
// names: whose packets, on which carrier, and in which of two ways the oscillators' phases cancel.
//
// With the other end's capture the product both ways; without it two antennas against each other. Warnings
// of captures go to standard error. Refuses (InputError) captures that cannot be read, levers that are not
// x,y,z, a sender that is not there or not the only one, a carrier that nothing tells, one antenna alone and
// answers that do not pair with the packets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/radio/capture_power.hpp"

namespace radioslam::cli {

/// As the command line has them.
struct AoaCaptures {
  std::string capture, reverse, transmitter;
  std::vector<std::string> levers;
  std::optional<int> channel;
};

/// Channels, and how strong the packets were that they come from.
struct HeardChannels {
  ChannelTrack track;
  CapturePower heard;
  std::optional<CapturePower> answers;
};

HeardChannels read_channels(const AoaCaptures& asked, const ArrivalParams& params);

}  // namespace radioslam::cli
