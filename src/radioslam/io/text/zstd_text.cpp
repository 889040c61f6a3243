#include "radioslam/io/text/zstd_text.hpp"

#include <zstd.h>

#include <algorithm>
#include <memory>

#include "radioslam/base/check.hpp"

namespace radioslam {

std::string decompress_zstd(const std::string& name, std::string_view bytes, std::size_t limit) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             &ZSTD_freeDStream);
  RADIOSLAM_CHECK(stream != nullptr, "memory for a decompressor");
  std::string content;
  std::string block(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer input{bytes.data(), bytes.size(), 0};
  std::size_t expected = 1;  // bytes that the frame still needs; 0 at its end
  bool more = true;
  while (more) {
    ZSTD_outBuffer output{block.data(), block.size(), 0};
    expected = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(expected) != 0)
      throw InputError(name, 0, std::string("cannot be decompressed: ") + ZSTD_getErrorName(expected));
    if (output.pos > limit - content.size())
      throw InputError(name, 0, "is larger than " + std::to_string(limit) + " bytes when decompressed");
    content.append(block.data(), output.pos);
    more = input.pos < input.size || output.pos == output.size;
  }
  if (expected != 0) throw InputError(name, 0, "cannot be decompressed: the file is truncated");
  return content;
}

bool has_zstd_extension(const std::filesystem::path& path) { return path.extension() == ".zst"; }

Text read_zstd_text(const std::filesystem::path& path) {
  if (!has_zstd_extension(path)) return read_text(path);
  return make_text(path.string(), decompress_zstd(path.string(), read_bytes(path)));
}

}  // namespace radioslam
