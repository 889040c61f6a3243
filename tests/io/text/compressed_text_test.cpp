#include "radioslam/io/text/compressed_text.hpp"

#include <bzlib.h>
#include <zlib.h>
#include <zstd.h>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"

namespace radioslam {
namespace {

std::string bzip2_of(std::string content) {
  std::string packed(content.size() + 1000, '\0');
  auto size = static_cast<unsigned>(packed.size());
  BZ2_bzBuffToBuffCompress(packed.data(), &size, content.data(), static_cast<unsigned>(content.size()), 1, 0,
                           0);
  packed.resize(size);
  return packed;
}

std::string gzip_of(std::string content) {
  std::string packed(content.size() + 1000, '\0');
  z_stream state{};
  deflateInit2(&state, 1, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  state.next_in = reinterpret_cast<Bytef*>(content.data());
  state.avail_in = static_cast<uInt>(content.size());
  state.next_out = reinterpret_cast<Bytef*>(packed.data());
  state.avail_out = static_cast<uInt>(packed.size());
  deflate(&state, Z_FINISH);
  packed.resize(packed.size() - state.avail_out);
  deflateEnd(&state);
  return packed;
}

std::string zstd_text_of(const std::string& content) {
  std::string packed(ZSTD_compressBound(content.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 1));
  return packed;
}

/// Longer than a decompressor's block.
std::string long_text() {
  std::string text;
  for (int k = 0; k < 60000; ++k) text += "line " + std::to_string(k) + "\n";
  return text;
}

TEST(PackedText, IsRecognisedByItsFirstBytes) {
  const TemporaryFolder folder;
  const std::string text = long_text();
  for (const std::string& bytes : {text, bzip2_of(text), gzip_of(text), zstd_text_of(text)})
    EXPECT_EQ(read_compressed_text(folder.write("log", bytes)).content, text);
  EXPECT_EQ(read_compressed_text(folder.write("log", gzip_of("\xff\xff"))).content, "\xff\xff")
      << "another program's encoding";
}

TEST(PackedText, SeveralPiecesAreOneText) {
  EXPECT_EQ(decompress_bzip2("log", bzip2_of("one\n") + bzip2_of("two\n")), "one\ntwo\n");
  EXPECT_EQ(decompress_gzip("log", gzip_of("one\n") + gzip_of("two\n")), "one\ntwo\n");
}

TEST(PackedText, RefusesTruncatedCorruptOrEndlessData) {
  for (const auto& [packed, decompress] : {std::pair(bzip2_of(long_text()), &decompress_bzip2),
                                           std::pair(gzip_of(long_text()), &decompress_gzip)}) {
    const auto read = [&, run = decompress](const std::string& bytes, std::size_t limit) {
      return [=] { run("log", bytes, limit); };
    };
    const std::size_t limit = kMaxDecompressed;
    expect_refusal(read(packed.substr(0, packed.size() - 9), limit), 0, "log: cannot be decompressed");
    expect_refusal(read("", limit), 0, "truncated");
    expect_refusal(read(packed + "garbage", limit), 0, "cannot be decompressed");
    std::string corrupt = packed;
    corrupt[corrupt.size() / 2] ^= 0x55;
    expect_refusal(read(corrupt, limit), 0, "cannot be decompressed");
    expect_refusal(read(packed, 1000), 0, "larger than 1000 bytes");
  }
}

}  // namespace
}  // namespace radioslam
