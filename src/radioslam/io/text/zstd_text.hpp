// Text files that may be compressed with Zstandard (RFC 8878), recognised by their name: `graph.pyfg.zst`.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Largest decompressed size; protects against small files that expand enormously.
inline constexpr std::size_t kMaxDecompressed = std::size_t{1} << 30U;

/// Decompresses one or several frames. `name` is used in error messages. Refuses (InputError) data that are
/// not Zstandard, are truncated, or are larger than `limit` when decompressed.
std::string decompress_zstd(const std::string& name, std::string_view bytes,
                            std::size_t limit = kMaxDecompressed);

/// Whether the path ends in .zst.
bool has_zstd_extension(const std::filesystem::path& path);

/// Reads a file as text and decompresses it if its name ends in .zst.
Text read_zstd_text(const std::filesystem::path& path);

}  // namespace radioslam
