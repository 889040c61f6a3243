// Decompression of gzip data (RFC 1952).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "radioslam/io/text/zstd_text.hpp"

namespace radioslam {

/// Decompresses one or several members. `name` is used in error messages. Refuses (InputError) data that are
/// not gzip, are truncated, or are larger than `limit` when decompressed.
std::string decompress_gzip(const std::string& name, std::string_view bytes,
                            std::size_t limit = kMaxDecompressed);

}  // namespace radioslam
