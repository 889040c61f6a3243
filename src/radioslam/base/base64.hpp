// Bytes as text (RFC 4648, section 4).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace radioslam {

std::string base64(std::string_view bytes);

/// Nothing for any text that `base64` did not write.
std::optional<std::string> bytes_of_base64(std::string_view text);

}  // namespace radioslam
