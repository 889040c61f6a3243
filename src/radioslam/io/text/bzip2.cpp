#include "radioslam/io/text/bzip2.hpp"

#include <bzlib.h>

#include <algorithm>
#include <limits>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kBzip2BlockBytes = 1 << 18;

/// RAII wrapper of a decompressor.
struct Bzip2Stream {
  Bzip2Stream() { RADIOSLAM_CHECK(BZ2_bzDecompressInit(&state, 0, 0) == BZ_OK, "memory for a decompressor"); }
  ~Bzip2Stream() { BZ2_bzDecompressEnd(&state); }
  Bzip2Stream(const Bzip2Stream&) = delete;
  Bzip2Stream& operator=(const Bzip2Stream&) = delete;

  bz_stream state{};
};

/// Decompresses the first stream in `bytes`, appends it to the output, and removes it from `bytes`.
void decompress_stream(const std::string& name, std::string_view& bytes, std::size_t limit,
                       std::string& content) {
  Bzip2Stream stream;
  std::string block(kBzip2BlockBytes, '\0');
  int result = BZ_OK;
  while (result != BZ_STREAM_END) {
    const std::size_t given = std::min<std::size_t>(bytes.size(), std::numeric_limits<unsigned>::max());
    stream.state.next_in = const_cast<char*>(bytes.data());  // libbz2 does not modify it
    stream.state.avail_in = static_cast<unsigned>(given);
    stream.state.next_out = block.data();
    stream.state.avail_out = static_cast<unsigned>(block.size());
    result = BZ2_bzDecompress(&stream.state);
    if (result != BZ_OK && result != BZ_STREAM_END)
      throw InputError(name, 0, "cannot be decompressed: corrupt or not bzip2");
    const std::size_t got = block.size() - stream.state.avail_out;
    const std::size_t taken = given - stream.state.avail_in;
    if (result == BZ_OK && got == 0 && taken == 0)
      throw InputError(name, 0, "cannot be decompressed: the file is truncated");
    bytes.remove_prefix(taken);
    content.append(block, 0, got);
    if (content.size() > limit)
      throw InputError(name, 0, "is larger than " + std::to_string(limit) + " bytes when decompressed");
  }
}

}  // namespace

std::string decompress_bzip2(const std::string& name, std::string_view bytes, std::size_t limit) {
  std::string content;
  do {
    decompress_stream(name, bytes, limit, content);
  } while (!bytes.empty());
  return content;
}

}  // namespace radioslam
