#include "radioslam/io/text/compressed_text.hpp"

#include "radioslam/io/text/bzip2.hpp"
#include "radioslam/io/text/gzip.hpp"
#include "radioslam/io/text/zstd_text.hpp"

namespace radioslam {
namespace {

std::string unpacked(const std::string& name, std::string bytes) {
  if (bytes.starts_with("\x1f\x8b")) return decompress_gzip(name, bytes);
  if (bytes.starts_with("BZh")) return decompress_bzip2(name, bytes);
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return decompress_zstd(name, bytes);
  return bytes;
}

}  // namespace

Text read_compressed_text(const std::filesystem::path& path) {
  return make_text(path.string(), unpacked(path.string(), read_bytes(path)));
}

}  // namespace radioslam
