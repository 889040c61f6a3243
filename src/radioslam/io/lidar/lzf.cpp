#include "radioslam/io/lidar/lzf.hpp"

#include <cstdint>

namespace radioslam {
namespace {

constexpr std::size_t kLiteralLimit = 32;
constexpr std::size_t kLongCopy = 7;  ///< value of the three length bits that is extended by another byte
constexpr std::size_t kMinCopy = 2;   ///< added to the coded length
constexpr std::size_t kMaxExpansion = 100;  ///< 3 bytes encode 264 at most

std::size_t lzf_byte(std::string_view bytes, std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); }

/// Appends `length` bytes beginning `distance` before the end of `out`; the ranges may overlap.
bool copy_back(std::string& out, std::size_t distance, std::size_t length) {
  if (distance > out.size()) return false;
  for (std::size_t k = 0; k < length; ++k) out += out[out.size() - distance];
  return true;
}

/// Decodes one literal run or copy at `at` and advances `at`.
bool decompress_run(std::string_view bytes, std::size_t& at, std::string& out) {
  const std::size_t code = lzf_byte(bytes, at++);
  if (code < kLiteralLimit) {
    if (bytes.size() - at < code + 1) return false;
    out.append(bytes.substr(at, code + 1));
    at += code + 1;
    return true;
  }
  std::size_t length = code >> 5U;
  if (bytes.size() - at < (length == kLongCopy ? 2U : 1U)) return false;
  if (length == kLongCopy) length += lzf_byte(bytes, at++);
  const std::size_t distance = ((code & 0x1fU) << 8U) + lzf_byte(bytes, at++) + 1;
  return copy_back(out, distance, length + kMinCopy);
}

}  // namespace

std::optional<std::string> decompress_lzf(std::string_view bytes, std::size_t size) {
  if (size / kMaxExpansion > bytes.size()) return std::nullopt;
  std::string out;
  out.reserve(size);
  for (std::size_t at = 0; at < bytes.size();)
    if (!decompress_run(bytes, at, out) || out.size() > size) return std::nullopt;
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace radioslam
