// Chunks of logs, looked at before they are taken (team_log.hpp).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace radioslam {

/// A chunk whose checksum holds; its records have not been decoded.
struct LogChunk {
  std::string robot;
  std::uint32_t life = 0;
  std::uint64_t first = 0;
  std::vector<std::string_view> records;
  std::string_view bytes;  ///< the whole of it
};

/// The chunks at the beginning of the bytes, up to what is damaged or no chunk.
std::vector<LogChunk> chunks_of(std::string_view bytes);

}  // namespace radioslam
