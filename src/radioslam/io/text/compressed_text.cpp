#include "radioslam/io/text/compressed_text.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kBlockBytes = 1 << 18;
constexpr const char* kTruncated = "the file is truncated";
constexpr const char* kNoMemory = "memory for a decompressor";

/// The text so far, and the block into which a decompressor writes.
struct Decompressed {
  const std::string& name;
  std::size_t limit;
  std::string content = {};
  std::string block = std::string(kBlockBytes, '\0');

  void append(std::size_t got) {
    content.append(block, 0, got);
    if (content.size() > limit)
      throw InputError(name, 0, "is larger than " + std::to_string(limit) + " bytes when decompressed");
  }
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(name, 0, "cannot be decompressed: " + reason);
  }
};

/// RAII wrapper of a decompressor.
struct Bzip2Stream {
  Bzip2Stream() { RADIOSLAM_CHECK(BZ2_bzDecompressInit(&state, 0, 0) == BZ_OK, kNoMemory); }
  ~Bzip2Stream() { BZ2_bzDecompressEnd(&state); }
  Bzip2Stream(const Bzip2Stream&) = delete;
  Bzip2Stream& operator=(const Bzip2Stream&) = delete;

  bz_stream state{};
};

/// Decompresses the first stream in `bytes` and removes it from them.
void decompress_stream(std::string_view& bytes, Decompressed& out) {
  Bzip2Stream stream;
  int result = BZ_OK;
  while (result != BZ_STREAM_END) {
    const std::size_t given = std::min<std::size_t>(bytes.size(), std::numeric_limits<unsigned>::max());
    stream.state.next_in = const_cast<char*>(bytes.data());  // libbz2 does not modify it
    stream.state.avail_in = static_cast<unsigned>(given);
    stream.state.next_out = out.block.data();
    stream.state.avail_out = static_cast<unsigned>(out.block.size());
    result = BZ2_bzDecompress(&stream.state);
    if (result != BZ_OK && result != BZ_STREAM_END) out.fail("corrupt or not bzip2");
    const std::size_t got = out.block.size() - stream.state.avail_out;
    const std::size_t taken = given - stream.state.avail_in;
    if (result == BZ_OK && got == 0 && taken == 0) out.fail(kTruncated);
    bytes.remove_prefix(taken);
    out.append(got);
  }
}

constexpr int kGzipOnly = 16 + MAX_WBITS;

/// RAII wrapper of a decompressor.
struct GzipStream {
  GzipStream() { RADIOSLAM_CHECK(inflateInit2(&state, kGzipOnly) == Z_OK, kNoMemory); }
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

using Lz4Context = std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)>;

Lz4Context make_lz4_context() {
  LZ4F_dctx* context = nullptr;
  RADIOSLAM_CHECK(LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) == 0, kNoMemory);
  return {context, &LZ4F_freeDecompressionContext};
}

std::string unpacked(const std::string& name, std::string bytes) {
  if (bytes.starts_with("\x1f\x8b")) return decompress_gzip(name, bytes);
  if (bytes.starts_with("BZh")) return decompress_bzip2(name, bytes);
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return decompress_zstd(name, bytes);
  return bytes;
}

}  // namespace

std::string decompress_gzip(const std::string& name, std::string_view bytes, std::size_t limit) {
  GzipStream stream;
  Decompressed out{name, limit};
  int result = Z_OK;
  while (result != Z_STREAM_END || stream.state.avail_in > 0 || !bytes.empty()) {
    if (result == Z_STREAM_END) inflateReset(&stream.state);  // another member follows
    feed(stream.state, bytes);
    stream.state.next_out = reinterpret_cast<Bytef*>(out.block.data());
    stream.state.avail_out = static_cast<uInt>(out.block.size());
    result = inflate(&stream.state, Z_NO_FLUSH);
    if (result == Z_BUF_ERROR) out.fail(kTruncated);
    if (result != Z_OK && result != Z_STREAM_END) out.fail("corrupt or not gzip");
    out.append(out.block.size() - stream.state.avail_out);
  }
  return std::move(out.content);
}

std::string decompress_bzip2(const std::string& name, std::string_view bytes, std::size_t limit) {
  Decompressed out{name, limit};
  do {
    decompress_stream(bytes, out);
  } while (!bytes.empty());
  return std::move(out.content);
}

std::string decompress_lz4(const std::string& name, std::string_view bytes, std::size_t limit) {
  const Lz4Context context = make_lz4_context();
  Decompressed out{name, limit};
  std::size_t expected = 1;  // bytes that the frame still needs; 0 at its end
  bool more = true;
  while (more) {
    std::size_t got = out.block.size();
    std::size_t taken = bytes.size();
    expected = LZ4F_decompress(context.get(), out.block.data(), &got, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(expected) != 0) out.fail(LZ4F_getErrorName(expected));
    RADIOSLAM_CHECK(taken > 0 || got > 0 || bytes.empty(), "a decompressor consumes or produces bytes");
    bytes.remove_prefix(taken);
    out.append(got);
    more = !bytes.empty() || got == out.block.size();
  }
  if (expected != 0) out.fail("the data are truncated");
  return std::move(out.content);
}

std::string decompress_zstd(const std::string& name, std::string_view bytes, std::size_t limit) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             &ZSTD_freeDStream);
  RADIOSLAM_CHECK(stream != nullptr, kNoMemory);
  Decompressed out{name, limit};
  ZSTD_inBuffer input{bytes.data(), bytes.size(), 0};
  std::size_t expected = 1;  // bytes that the frame still needs; 0 at its end
  bool more = true;
  while (more) {
    ZSTD_outBuffer output{out.block.data(), out.block.size(), 0};
    expected = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(expected) != 0) out.fail(ZSTD_getErrorName(expected));
    out.append(output.pos);
    more = input.pos < input.size || output.pos == output.size;
  }
  if (expected != 0) out.fail(kTruncated);
  return std::move(out.content);
}

Text read_compressed_text(const std::filesystem::path& path) {
  return make_tool_output(path.string(), unpacked(path.string(), read_bytes(path)));
}

bool has_zstd_extension(const std::filesystem::path& path) { return path.extension() == ".zst"; }

Text read_zstd_text(const std::filesystem::path& path) {
  if (!has_zstd_extension(path)) return read_text(path);
  return make_text(path.string(), decompress_zstd(path.string(), read_bytes(path)));
}

}  // namespace radioslam
