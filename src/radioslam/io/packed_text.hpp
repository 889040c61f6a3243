// Texts that may be compressed, told by their first bytes: gzip, bzip2 or Zstandard.
#pragma once

#include <filesystem>

#include "radioslam/io/text.hpp"

namespace radioslam {

/// Reads a file as text, decompressed where it is compressed. Refuses what make_text refuses.
Text read_packed_text(const std::filesystem::path& path);

}  // namespace radioslam
