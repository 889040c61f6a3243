#include "radioslam/io/text/lz4.hpp"

#include <lz4frame.h>

#include <memory>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kLz4BlockBytes = 1 << 18;

using Lz4Context = std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)>;

Lz4Context make_lz4_context() {
  LZ4F_dctx* context = nullptr;
  RADIOSLAM_CHECK(LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) == 0,
                  "memory for a decompressor");
  return {context, &LZ4F_freeDecompressionContext};
}

}  // namespace

std::string decompress_lz4(const std::string& name, std::string_view bytes, std::size_t limit) {
  const Lz4Context context = make_lz4_context();
  std::string content;
  std::string block(kLz4BlockBytes, '\0');
  std::size_t expected = 1;  // bytes that the frame still needs; 0 at its end
  bool more = true;
  while (more) {
    std::size_t got = block.size();
    std::size_t taken = bytes.size();
    expected = LZ4F_decompress(context.get(), block.data(), &got, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(expected) != 0)
      throw InputError(name, 0, std::string("cannot be decompressed: ") + LZ4F_getErrorName(expected));
    RADIOSLAM_CHECK(taken > 0 || got > 0 || bytes.empty(), "a decompressor consumes or produces bytes");
    bytes.remove_prefix(taken);
    content.append(block, 0, got);
    if (content.size() > limit)
      throw InputError(name, 0, "is larger than " + std::to_string(limit) + " bytes when decompressed");
    more = !bytes.empty() || got == block.size();
  }
  if (expected != 0) throw InputError(name, 0, "cannot be decompressed: the data are truncated");
  return content;
}

}  // namespace radioslam
