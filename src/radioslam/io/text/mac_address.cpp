#include "radioslam/io/text/mac_address.hpp"

#include <cstddef>

namespace radioslam {
namespace {

constexpr std::size_t kCharactersPerByte = 3;

std::optional<unsigned> hexadecimal_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10;
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10;
  return std::nullopt;
}

}  // namespace

std::optional<MacAddress> parse_mac_address(std::string_view text) {
  if (text.size() != kMacTextLength || (text[2] != ':' && text[2] != '-')) return std::nullopt;
  MacAddress address;
  for (std::size_t at = 0; at < text.size(); at += kCharactersPerByte) {
    const auto high = hexadecimal_digit(text[at]), low = hexadecimal_digit(text[at + 1]);
    if (!high || !low || (at + 2 < text.size() && text[at + 2] != text[2])) return std::nullopt;
    address.value = address.value << 8U | *high << 4U | *low;
  }
  return address;
}

std::string format_mac_address(MacAddress address) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t k = 0; k < MacAddress::kBytes; ++k) {
    const std::uint64_t byte = address.value >> (8 * (MacAddress::kBytes - 1 - k)) & 0xffU;
    if (k > 0) text += ':';
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 0xfU];
  }
  return text;
}

}  // namespace radioslam
