// Decompression of gzip (RFC 1952), bzip2, LZ4 and Zstandard (RFC 8878), and text files that may be
// compressed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Largest decompressed size; protects against small files that expand enormously.
inline constexpr std::size_t kMaxDecompressed = std::size_t{1} << 30U;

/// Each decompresses one or several members, streams or frames. `name` is used in error messages. Refuses
/// (InputError) data of another format, truncated ones, and those that are larger than `limit` when
/// decompressed.
std::string decompress_gzip(const std::string& name, std::string_view bytes,
                            std::size_t limit = kMaxDecompressed);
std::string decompress_bzip2(const std::string& name, std::string_view bytes,
                             std::size_t limit = kMaxDecompressed);
std::string decompress_lz4(const std::string& name, std::string_view bytes,
                           std::size_t limit = kMaxDecompressed);
std::string decompress_zstd(const std::string& name, std::string_view bytes,
                            std::size_t limit = kMaxDecompressed);

/// Reads a file as text that may be compressed with gzip, bzip2 or Zstandard, recognised by its first bytes.
/// Refuses (InputError) whatever make_tool_output refuses.
Text read_compressed_text(const std::filesystem::path& path);

/// Whether the path ends in .zst: `graph.pyfg.zst`.
bool has_zstd_extension(const std::filesystem::path& path);

/// Reads a file as text and decompresses it if its name ends in .zst.
Text read_zstd_text(const std::filesystem::path& path);

}  // namespace radioslam
