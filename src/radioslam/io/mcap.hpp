// MCAP files (mcap.dev/spec): a magic, records of u8 opcode, u64 length and content, little endian, and the
// magic again. Read from front to back, so that neither index nor summary is needed: a file that was cut off
// is read as far as it goes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/ros_recording.hpp"

namespace radioslam {

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

/// Hands the messages of channels encoded as cdr or ros1 to the visitor; others are skipped, with a warning.
/// Chunks may be compressed with lz4 or zstd. Refuses (InputError, with the byte) records that contradict
/// themselves, chunks that cannot be decompressed or whose checksum differs, messages of an unknown channel.
std::vector<std::string> visit_mcap(const std::string& name, std::string_view bytes,
                                    const RosVisitor& visitor);

}  // namespace radioslam
