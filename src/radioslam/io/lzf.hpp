// LZF, the compression of PCD files (binary_compressed): a byte below 32 precedes that many literal bytes
// plus one; any other says how many bytes, in its upper three bits, are to be copied from how far back.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace radioslam {

/// The content of compressed bytes; nothing where they are no LZF or are not of `size` bytes when
/// decompressed. Never takes more memory than 100 times the bytes.
std::optional<std::string> decompress_lzf(std::string_view bytes, std::size_t size);

}  // namespace radioslam
