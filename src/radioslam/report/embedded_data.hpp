// Embeds data in a page as one JSON element between its fixed head and tail.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace radioslam {

/// The page. Foreign text remains text: nothing in `data` can end its element, and invalid UTF-8 is replaced.
std::string embed_data(std::string_view head, const nlohmann::ordered_json& data, std::string_view tail);

}  // namespace radioslam
