// Adds an entry to a map of a YAML text that people edit: all other bytes of the text stay as they are.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// The text with `key: value` as the last entry of the map at `path` (keys from the root on), in the style of
/// that map: within its braces, or on a line of its own with the indentation of the other entries. Key and
/// value are YAML. A map without entries may have no value at all. Refuses (InputError) a text that is not
/// YAML, and a path that does not lead to a map. Where comments or the layout defeat this, the result may not
/// be what is meant: read it again before it is used.
std::string with_yaml_entry(const Text& text, const std::vector<std::string>& path, const std::string& key,
                            const std::string& value);

}  // namespace radioslam
