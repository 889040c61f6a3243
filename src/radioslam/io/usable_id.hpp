// Can this name be a robot's? It becomes the name of files and stands in tables.
#pragma once

#include <string>

namespace radioslam {

/// Not empty, short enough for a file's name, no path, comma, quote or control character, no '.' or '#' in
/// front, no blanks at the ends.
bool is_usable_id(const std::string& id);

}  // namespace radioslam
