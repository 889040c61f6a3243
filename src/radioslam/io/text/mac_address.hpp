// MAC addresses as text: "00:21:6a:3f:17:5a".
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Characters of an address as text.
inline constexpr std::size_t kMacTextLength = 17;

/// Parses six bytes of two hexadecimal digits, in either case, all separated by ':' or all by '-'.
std::optional<MacAddress> parse_mac_address(std::string_view text);

/// Formats an address in lower case with ':' as separator.
std::string format_mac_address(MacAddress address);

/// Formats an address in any common spelling so: six bytes separated by ':' or '-', also without leading
/// zeros, three groups of four digits separated by '.', or twelve digits. Other texts: in lower case.
std::string canonical_bssid(std::string_view text);

}  // namespace radioslam
