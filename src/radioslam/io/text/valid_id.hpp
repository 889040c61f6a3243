// Validity of names of robots and anchors, which are used as file names and in tables.
#pragma once

#include <string>

namespace radioslam {

/// Whether the name is not empty, short enough for a file name, without path separators, commas, quotes or
/// control characters, without a leading '.' or '#', and without leading or trailing blanks.
bool is_valid_id(const std::string& id);

}  // namespace radioslam
