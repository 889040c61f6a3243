// Reader of YAML maps, key by key, whose errors name the line.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// The known keys, each with a function that takes its value.
using YamlKeyHandlers = std::map<std::string, std::function<void(const YAML::Node& value)>, std::less<>>;

/// A node's line, counted from 1.
std::size_t line_of(const YAML::Node& node);

/// Parses a text; refuses invalid YAML.
YAML::Node load_yaml(const Text& text);

/// One `key: value` entry with the key's line.
struct YamlEntry {
  std::string key;
  std::size_t line;
  YAML::Node value;
};

/// Calls `use` for every entry in the file's order. Refuses nodes that are not maps, and repeated keys.
void for_each_key(const Text& text, const YAML::Node& map, std::string_view what,
                  const std::function<void(const YamlEntry&)>& use);

/// Passes every value to its key's function; also refuses unknown keys. `what` names the map in messages.
void read_yaml_map(const Text& text, const YAML::Node& map, std::string_view what,
                   const YamlKeyHandlers& keys);

/// A single value.
std::string scalar_at(const Text& text, const YAML::Node& node, std::string_view what);
double number_at(const Text& text, const YAML::Node& node, std::string_view what);

}  // namespace radioslam
