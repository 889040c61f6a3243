// Decompression of bzip2 data.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "radioslam/io/text/zstd_text.hpp"

namespace radioslam {

/// Decompresses one or several streams. `name` is used in error messages. Refuses (InputError) data that are
/// not bzip2, are truncated, or are larger than `limit` when decompressed.
std::string decompress_bzip2(const std::string& name, std::string_view bytes,
                             std::size_t limit = kMaxDecompressed);

}  // namespace radioslam
