#include "radioslam/io/text/yaml_map.hpp"

#include <set>

#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

std::size_t line_at(const YAML::Mark& mark) {
  return mark.line < 0 ? 1 : static_cast<std::size_t>(mark.line) + 1;
}

}  // namespace

std::size_t line_of(const YAML::Node& node) { return line_at(node.Mark()); }

YAML::Node load_yaml(const Text& text) {
  try {
    return YAML::Load(text.content);
  } catch (const YAML::Exception& error) {
    text.fail(line_at(error.mark), "not valid YAML: " + error.msg);
  }
}

void for_each_key(const Text& text, const YAML::Node& map, std::string_view what,
                  const std::function<void(const YamlEntry&)>& use) {
  if (map.IsNull()) return;
  if (!map.IsMap()) text.fail(line_of(map), std::string(what) + " must hold 'key: value' entries");
  std::set<std::string> seen;
  for (const auto& entry : map) {
    const YamlEntry found{scalar_at(text, entry.first, "a key"), line_of(entry.first), entry.second};
    if (!seen.insert(found.key).second)
      text.fail(found.line, "'" + found.key + "' appears twice in " + std::string(what),
                InputError::Kind::kDuplicate);
    use(found);
  }
}

void read_yaml_map(const Text& text, const YAML::Node& map, std::string_view what,
                   const YamlKeyHandlers& keys) {
  for_each_key(text, map, what, [&](const YamlEntry& entry) {
    const auto found = keys.find(entry.key);
    if (found == keys.end()) text.fail(entry.line, "unknown key '" + entry.key + "' in " + std::string(what));
    found->second(entry.value);
  });
}

std::string scalar_at(const Text& text, const YAML::Node& node, std::string_view what) {
  if (!node.IsScalar()) text.fail(line_of(node), std::string(what) + " must be a single value");
  return node.Scalar();
}

double number_at(const Text& text, const YAML::Node& node, std::string_view what) {
  const std::string scalar = scalar_at(text, node, what);
  const auto value = parse_number(scalar);
  if (!value) text.fail(line_of(node), std::string(what) + " '" + scalar + "' is not a finite number");
  return *value;
}

}  // namespace radioslam
