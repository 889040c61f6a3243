// Sizes in Intel 5300 capture files (intel5300.hpp), shared by reader and writer.
#pragma once

#include <cstddef>
#include <cstdint>

namespace radioslam::intel5300 {

inline constexpr std::uint8_t kChannelCode = 187;
inline constexpr std::size_t kSubcarriers = 30, kSkippedBits = 3, kBitsPerValue = 16;
inline constexpr std::size_t kStockHeader = 20, kLongHeader = 38;
inline constexpr std::size_t kMaxAntennas = 3;
inline constexpr unsigned kWideChannelFlag = 0x800;

inline constexpr std::size_t bytes_of_channel(std::size_t antennas, std::size_t streams) {
  return (kSubcarriers * (antennas * streams * kBitsPerValue + kSkippedBits) + 7) / 8;
}

}  // namespace radioslam::intel5300
