#include "radioslam/io/text/gzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kGzipBlockBytes = 1 << 18;
constexpr int kGzipOnly = 16 + MAX_WBITS;

/// RAII wrapper of a decompressor.
struct GzipStream {
  GzipStream() { RADIOSLAM_CHECK(inflateInit2(&state, kGzipOnly) == Z_OK, "memory for a decompressor"); }
  ~GzipStream() { inflateEnd(&state); }
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  z_stream state{};
};

/// Passes the next chunk of unread input to the decompressor.
void feed(z_stream& state, std::string_view& rest) {
  if (state.avail_in > 0) return;
  const std::size_t taken = std::min<std::size_t>(rest.size(), std::numeric_limits<uInt>::max());
  state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest.data()));  // zlib does not modify it
  state.avail_in = static_cast<uInt>(taken);
  rest.remove_prefix(taken);
}

}  // namespace

std::string decompress_gzip(const std::string& name, std::string_view bytes, std::size_t limit) {
  GzipStream stream;
  std::string content;
  std::string block(kGzipBlockBytes, '\0');
  int result = Z_OK;
  while (result != Z_STREAM_END || stream.state.avail_in > 0 || !bytes.empty()) {
    if (result == Z_STREAM_END) inflateReset(&stream.state);  // another member follows
    feed(stream.state, bytes);
    stream.state.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.state.avail_out = static_cast<uInt>(block.size());
    result = inflate(&stream.state, Z_NO_FLUSH);
    if (result == Z_BUF_ERROR) throw InputError(name, 0, "cannot be decompressed: the file is truncated");
    if (result != Z_OK && result != Z_STREAM_END)
      throw InputError(name, 0, "cannot be decompressed: corrupt or not gzip");
    content.append(block, 0, block.size() - stream.state.avail_out);
    if (content.size() > limit)
      throw InputError(name, 0, "is larger than " + std::to_string(limit) + " bytes when decompressed");
  }
  return content;
}

}  // namespace radioslam
