#include "radioslam/io/text/yaml_insertion.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace radioslam {
namespace {

/// A map, and the key that it belongs to.
struct FoundMap {
  YAML::Node key, map;
};

FoundMap find_map(const Text& text, const std::vector<std::string>& path) {
  FoundMap found;
  try {
    found.map.reset(YAML::Load(text.content));
  } catch (const YAML::Exception& error) {
    text.fail(static_cast<std::size_t>(error.mark.line + 1), "not valid YAML: " + error.msg);
  }
  for (const std::string& name : path) {
    FoundMap inner;
    for (const auto& entry : found.map)
      if (entry.first.IsScalar() && entry.first.Scalar() == name) inner = {entry.first, entry.second};
    if (!inner.key.IsDefined() || inner.key.IsNull() || !(inner.map.IsMap() || inner.map.IsNull()))
      text.fail(0, "has no map '" + name + "'");
    found.key.reset(inner.key);
    found.map.reset(inner.map);
  }
  return found;
}

/// Position of a mark; lines and columns are counted from 0.
std::size_t position_of(std::string_view content, const YAML::Mark& mark) {
  std::size_t line_begin = 0;
  for (int line = 0; line < mark.line; ++line) line_begin = content.find('\n', line_begin) + 1;
  return line_begin + static_cast<std::size_t>(mark.column);
}

/// Behind the quoted text or the comment that begins at `at`; `at` itself if none does.
std::size_t behind_quote_or_comment(std::string_view content, std::size_t at) {
  const char c = content[at];
  if (c == '#' && at > 0 && (content[at - 1] == ' ' || content[at - 1] == '\n'))
    return std::min(content.find('\n', at), content.size());
  if (c != '"' && c != '\'') return at;
  for (std::size_t k = at + 1; k < content.size(); ++k) {
    if (c == '"' && content[k] == '\\')
      ++k;
    else if (content[k] == c)
      return k + 1;
  }
  return content.size();
}

/// The place of the brace that closes the one at `open`.
std::optional<std::size_t> closing_brace(std::string_view content, std::size_t open) {
  int depth = 0;
  for (std::size_t at = open; at < content.size();) {
    const std::size_t behind = behind_quote_or_comment(content, at);
    if (behind != at) {
      at = behind;
      continue;
    }
    if (content[at] == '{' || content[at] == '[') ++depth;
    if ((content[at] == '}' || content[at] == ']') && --depth == 0) return at;
    ++at;
  }
  return std::nullopt;
}

std::size_t end_of_line(std::string_view content, std::size_t at) {
  return std::min(content.find('\n', at), content.size());
}

/// Behind the last line of the block map whose first key is at `first`: its lines are indented as far as the
/// key or further, and it ends with one that has content.
std::size_t end_of_block(std::string_view content, std::size_t first, std::size_t indent) {
  std::size_t end = end_of_line(content, first);
  for (std::size_t begin = end + 1; begin < content.size();) {
    const std::size_t stop = end_of_line(content, begin);
    const std::string_view line = content.substr(begin, stop - begin);
    const std::size_t blanks = std::min(line.find_first_not_of(" \t\r"), line.size());
    const bool has_content = blanks < line.size() && line[blanks] != '#';
    if (has_content && blanks < indent) break;
    if (has_content) end = stop;
    begin = stop + 1;
  }
  return end;
}

}  // namespace

std::string with_yaml_entry(const Text& text, const std::vector<std::string>& path, const std::string& key,
                            const std::string& value) {
  const FoundMap found = find_map(text, path);
  std::string content = text.content;
  const std::string entry = key + ": " + value;
  if (found.map.IsNull()) {
    const std::size_t colon = content.find(':', position_of(content, found.key.Mark()));
    if (colon == std::string::npos) text.fail(0, "has no map '" + path.back() + "'");
    return content.insert(colon + 1, " {" + entry + "}");
  }
  const std::size_t begin = position_of(content, found.map.Mark());
  if (begin < content.size() && content[begin] == '{') {
    const auto close = closing_brace(content, begin);
    if (!close) text.fail(0, "has no end of the map '" + path.back() + "'");
    return content.insert(*close, (found.map.size() > 0 ? ", " : "") + entry);
  }
  const auto indent = static_cast<std::size_t>(found.map.Mark().column);
  const std::size_t end = end_of_block(content, begin, indent);
  return content.insert(end, "\n" + std::string(indent, ' ') + entry);
}

}  // namespace radioslam
