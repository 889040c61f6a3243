// Channels between a moving antenna and another radio, read from the captures given to `radioslam aoa`.
//
// The oscillators' phases cancel in the two-way product if the other end's capture is given, otherwise
// between two antennas of the same capture. Warnings go to standard error. Refuses (InputError) captures that
// cannot be read, lever arms that are not x,y,z, a missing or ambiguous sender, an unknown carrier, a single
// antenna without the other end's capture, and answers that cannot be paired with the packets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/radio/channel/capture_power.hpp"

namespace radioslam::cli {

/// The captures and related options of the command line.
struct AoaCaptures {
  std::string capture, reverse, transmitter;
  std::vector<std::string> levers;
  std::optional<int> channel;
};

/// Channels and the power of the packets they were measured on.
struct CsiChannels {
  ChannelTrack track;
  CapturePower heard;
  std::optional<CapturePower> answers;
};

CsiChannels read_channels(const AoaCaptures& asked, const AoaParams& params);

}  // namespace radioslam::cli
