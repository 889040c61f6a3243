// Text files that may be compressed with gzip, bzip2 or Zstandard, recognised by their first bytes.
#pragma once

#include <filesystem>

#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Reads a file as text and decompresses it if necessary. Refuses (InputError) whatever make_text refuses.
Text read_compressed_text(const std::filesystem::path& path);

}  // namespace radioslam
