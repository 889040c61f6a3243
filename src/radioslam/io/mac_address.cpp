#include "radioslam/io/mac_address.hpp"

#include <charconv>
#include <cstdint>

namespace radioslam {
namespace {

constexpr std::size_t kAddressBytes = 6, kDigitsPerByte = 2, kTextStep = kDigitsPerByte + 1;
constexpr int kHexadecimal = 16;
constexpr unsigned kByteBits = 8;
constexpr std::string_view kHexadecimalDigits = "0123456789abcdef";

}  // namespace

std::optional<MacAddress> parse_mac_address(std::string_view text) {
  if (text.size() != kAddressBytes * kTextStep - 1) return std::nullopt;
  const char parting = text[kDigitsPerByte];
  if (parting != ':' && parting != '-') return std::nullopt;
  MacAddress address;
  for (std::size_t at = 0; at < text.size(); at += kTextStep) {
    if (at > 0 && text[at - 1] != parting) return std::nullopt;
    std::uint8_t byte = 0;
    const char* end = text.data() + at + kDigitsPerByte;
    const auto [stop, error] = std::from_chars(text.data() + at, end, byte, kHexadecimal);
    if (error != std::errc{} || stop != end) return std::nullopt;
    address.value = address.value << kByteBits | byte;
  }
  return address;
}

std::string to_text(MacAddress address) {
  std::string text;
  for (std::size_t byte = kAddressBytes; byte > 0; --byte) {
    const std::uint64_t value = address.value >> (kByteBits * (byte - 1));
    if (!text.empty()) text += ':';
    text += kHexadecimalDigits[value >> 4U & 0xfU];
    text += kHexadecimalDigits[value & 0xfU];
  }
  return text;
}

}  // namespace radioslam
