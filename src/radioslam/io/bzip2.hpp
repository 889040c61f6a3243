// Content compressed with bzip2.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "radioslam/io/zstd_text.hpp"

namespace radioslam {

/// The content of compressed bytes, one stream or several. `name` is for messages. Refuses what is no bzip2,
/// ends early or is larger than `limit`.
std::string decompress_bzip2(const std::string& name, std::string_view bytes,
                             std::size_t limit = kLargestDecompressed);

}  // namespace radioslam
