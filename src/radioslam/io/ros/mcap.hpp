// Reads MCAP files (mcap_format.hpp) sequentially, without their index and summary, so that a truncated file
// can be read up to its end.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/ros/ros_recording.hpp"

namespace radioslam {

/// Passes the messages of channels encoded as cdr or ros1 to the visitor; others are skipped with a warning.
/// Chunks may be compressed with lz4 or zstd. Inconsistent records, chunks that cannot be decompressed or
/// have a wrong checksum, messages of unknown channels, zeros and all behind a cut are left out. Returns the
/// warnings: what is left out, and the first of its kind with its byte.
std::vector<std::string> visit_mcap(const std::string& name, std::string_view bytes,
                                    const RosVisitor& visitor);

}  // namespace radioslam
