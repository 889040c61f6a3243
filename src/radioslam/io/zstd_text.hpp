// Texts that may be compressed with Zstandard (RFC 8878): told by the name, `graph.pyfg.zst`.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "radioslam/io/text.hpp"

namespace radioslam {

/// What is larger than this when decompressed is refused: a few kilobytes can expand without end.
inline constexpr std::size_t kLargestDecompressed = std::size_t{1} << 30U;

/// The content of compressed bytes, one frame or several. `name` is for messages. Refuses what is no
/// Zstandard, ends early or is larger than `limit`.
std::string decompress_zstd(const std::string& name, std::string_view bytes,
                            std::size_t limit = kLargestDecompressed);

/// Does the path end in .zst?
bool is_compressed(const std::filesystem::path& path);

/// Reads a file as text, decompressed where its name says so.
Text read_compressed_text(const std::filesystem::path& path);

}  // namespace radioslam
