#include "radioslam/io/text/mac_address.hpp"

#include <algorithm>
#include <cstddef>

#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kCharactersPerByte = 3;

std::optional<unsigned> hexadecimal_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10;
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10;
  return std::nullopt;
}

/// Addresses of six, three or one group of digits; bytes may lack their leading zeros.
std::optional<MacAddress> address_in_groups(std::string_view text) {
  constexpr std::size_t kDigits = 2 * MacAddress::kBytes;
  const auto separator = std::find_if(text.begin(), text.end(), [](char c) { return !hexadecimal_digit(c); });
  const bool is_whole = separator == text.end();
  const std::size_t groups =
      is_whole ? 1 : static_cast<std::size_t>(std::count(text.begin(), text.end(), *separator)) + 1;
  const char expected = groups == 3 ? '.' : ':';
  if (!is_whole && *separator != expected && (groups != 6 || *separator != '-')) return std::nullopt;
  if (groups != 1 && groups != 3 && groups != 6) return std::nullopt;
  MacAddress address;
  for (std::size_t group = 0; group < groups; ++group) {
    const std::string_view digits = text.substr(0, is_whole ? text.size() : text.find(*separator));
    if (digits.size() != kDigits / groups && (groups != 6 || digits.size() != 1)) return std::nullopt;
    if (digits.size() == 1) address.value <<= 4U;  // a leading zero
    for (const char c : digits) {
      const auto digit = hexadecimal_digit(c);
      if (!digit) return std::nullopt;
      address.value = address.value << 4U | *digit;
    }
    text.remove_prefix(std::min(text.size(), digits.size() + 1));
  }
  return address;
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

std::string canonical_bssid(std::string_view text) {
  const auto address = address_in_groups(text);
  return address ? format_mac_address(*address) : lower_case(text);
}

}  // namespace radioslam
