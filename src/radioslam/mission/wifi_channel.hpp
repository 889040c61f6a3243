// Where in the spectrum a WiFi channel lies.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace radioslam {

/// The carrier of a channel by its number: 2407 + 5 n MHz for 1 to 13, 2484 MHz for 14, 5000 + 5 n MHz for 32
/// to 177. Nothing for other numbers.
std::optional<double> carrier_of_channel_hz(std::int64_t channel);

/// The channel with exactly this carrier, if there is one.
std::optional<std::int64_t> channel_of_carrier(double carrier_hz);

enum class ChannelWidth { k20MHz, k40MHz };

/// The 30 subcarriers that 802.11n reports of a channel in groups of two (20 MHz) or four (40 MHz), from the
/// carrier; what the Intel 5300 measures.
std::vector<double> grouped_subcarriers_hz(ChannelWidth width);

}  // namespace radioslam
