#include "radioslam/base/base64.hpp"

#include <cstdint>

namespace radioslam {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string base64(std::string_view bytes) {
  std::string text;
  text.reserve(4 * (bytes.size() + 2) / 3);
  const auto byte = [&](std::size_t k) {
    return k < bytes.size() ? std::uint32_t{static_cast<std::uint8_t>(bytes[k])} : 0U;
  };
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::uint32_t three = byte(k) << 16U | byte(k + 1) << 8U | byte(k + 2);
    for (std::size_t digit = 0; digit < 4; ++digit)
      text += k + digit <= bytes.size() ? kDigits[(three >> (18 - 6 * digit)) & 63U] : '=';
  }
  return text;
}

std::optional<std::string> bytes_of_base64(std::string_view text) {
  std::string bytes;
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6U | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(static_cast<unsigned char>(bits >> count));
  }
  if (base64(bytes) != text) return std::nullopt;
  return bytes;
}

}  // namespace radioslam
