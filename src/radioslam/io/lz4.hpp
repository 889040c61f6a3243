// Content compressed with LZ4, in frames.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "radioslam/io/zstd_text.hpp"

namespace radioslam {

/// The content of compressed bytes, one frame or several. `name` is for messages. Refuses what is no LZ4
/// frame, ends early or is larger than `limit`.
std::string decompress_lz4(const std::string& name, std::string_view bytes,
                           std::size_t limit = kLargestDecompressed);

}  // namespace radioslam
