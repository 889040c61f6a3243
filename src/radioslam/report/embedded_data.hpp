// Data inside a page that was written beforehand: one JSON element between its head and its tail.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace radioslam {

/// The page. Foreign text stays text: nothing in `data` can end the element it stands in, and bytes that are
/// no UTF-8 are replaced.
std::string embed_data(std::string_view head, const nlohmann::ordered_json& data, std::string_view tail);

}  // namespace radioslam
