// Carrier and subcarrier frequencies of WiFi channels.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace radioslam {

/// Carrier of a channel number: 2407 + 5 n MHz for 1 to 13, 2484 MHz for 14, 5000 + 5 n MHz for 32 to 177.
/// Nothing for other numbers.
std::optional<double> carrier_of_channel_hz(std::int64_t channel);

/// A frequency in Hz, kHz, MHz or GHz as MHz; 0 unless it is positive.
double megahertz(double frequency);

/// Channel with exactly this carrier, if there is one.
std::optional<std::int64_t> channel_of_carrier(double carrier_hz);

enum class ChannelWidth { k20MHz, k40MHz };

/// Offsets from the carrier of the 30 subcarriers that 802.11n reports in groups of two (20 MHz) or four (40
/// MHz), as measured by the Intel 5300.
std::vector<double> grouped_subcarriers_hz(ChannelWidth width);

}  // namespace radioslam
