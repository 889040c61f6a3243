// Decompression of LZF, used in PCD files (binary_compressed): a byte n below 32 is followed by n + 1 literal
// bytes; any other byte encodes a copy, with the length in its upper three bits and the distance in the
// others and the next byte.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace radioslam {

/// Decompresses the bytes; nothing if they are not LZF or do not have `size` bytes when decompressed.
/// Allocates at most 100 times the size of the input.
std::optional<std::string> decompress_lzf(std::string_view bytes, std::size_t size);

}  // namespace radioslam
