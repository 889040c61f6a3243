// Maps of a YAML file, key by key, so that every refusal names its line.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "radioslam/io/text.hpp"

namespace radioslam {

/// What to do with the value of each key that is known.
using YamlKeys = std::map<std::string, std::function<void(const YAML::Node& value)>, std::less<>>;

/// A node's line, from 1.
std::size_t line_of(const YAML::Node& node);

/// Parses a text; what is no YAML is refused.
YAML::Node load_yaml(const Text& text);

/// One `key: value`, with the key's line.
struct YamlEntry {
  std::string key;
  std::size_t line;
  YAML::Node value;
};

/// Calls `use` for every entry, in the file's order. Refuses what is no map and a doubled key.
void for_each_key(const Text& text, const YAML::Node& map, std::string_view what,
                  const std::function<void(const YamlEntry&)>& use);

/// Hands every value to its key's function; refuses also keys that are not known. `what` names the map.
void read_yaml_map(const Text& text, const YAML::Node& map, std::string_view what, const YamlKeys& keys);

/// A single value.
std::string scalar_at(const Text& text, const YAML::Node& node, std::string_view what);
double number_at(const Text& text, const YAML::Node& node, std::string_view what);

}  // namespace radioslam
