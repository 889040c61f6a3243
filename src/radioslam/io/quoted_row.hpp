// One row of a CSV whose fields may be quoted.
#pragma once

#include <string_view>
#include <vector>

namespace radioslam {

/// The fields between commas, without the double quotes around them; a comma inside quotes separates nothing.
std::vector<std::string_view> split_quoted_row(std::string_view line);

}  // namespace radioslam
