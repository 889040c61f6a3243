// Addresses of network cards as text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Six bytes in hexadecimal digits, two each, all parted by ':' or all by '-'. Nothing for other text.
std::optional<MacAddress> parse_mac_address(std::string_view text);

/// Lower case, parted by ':', as in "00:16:ea:00:00:01".
std::string to_text(MacAddress address);

}  // namespace radioslam
