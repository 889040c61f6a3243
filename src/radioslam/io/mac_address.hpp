// Addresses of WiFi cards as text: "00:21:6a:3f:17:5a".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Six bytes of two hexadecimal digits each, of either case, all joined by ':' or all by '-'; nothing
/// otherwise.
std::optional<MacAddress> parse_mac_address(std::string_view text);

/// In lower case, joined by ':'.
std::string format_mac_address(MacAddress address);

}  // namespace radioslam
