// JSON of the report page: an object with the keys in the order of their insertion.
#pragma once

#include <nlohmann/json.hpp>

namespace radioslam {

using PageData = nlohmann::ordered_json;

}  // namespace radioslam
