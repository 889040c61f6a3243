#include "radioslam/cli/config.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace radioslam::cli {
namespace {

std::size_t line_of(const YAML::Mark& mark) {
  return mark.is_null() ? 0 : static_cast<std::size_t>(mark.line) + 1;
}

// Parameters are nested two or three levels deep. These limits reject YAML aliases that refer to an enclosing
// map (infinite depth) and aliases of aliases (exponential size).
constexpr int kDeepest = 8;
constexpr std::size_t kMaxEntries = 10'000;

/// Collects the leaves of nested maps as settings with dotted keys.
class ConfigReader {
 public:
  explicit ConfigReader(const Text& text) : text_(&text) {}

  void read(const YAML::Node& node, const std::string& key, int depth = 0) {
    if (depth > kDeepest) text_->fail(line_of(node.Mark()), "'" + key + "' is nested too deeply");
    if (node.IsMap()) return read_map(node, key.empty() ? key : key + ".", depth + 1);
    if (node.IsScalar() && !key.empty()) return add(node, key);
    if (node.IsNull()) return;
    const std::string what = key.empty() ? "the file" : "'" + key + "'";
    text_->fail(line_of(node.Mark()), what + " must hold 'name: value' lines");
  }

  const std::vector<Setting>& settings() const { return settings_; }

 private:
  void read_map(const YAML::Node& node, const std::string& prefix, int depth) {
    for (const auto& entry : node) {
      if (++entries_ > kMaxEntries) text_->fail(line_of(node.Mark()), "more than 10000 entries");
      if (!entry.first.IsScalar())
        text_->fail(line_of(entry.first.Mark()), "a parameter name must be plain text");
      read(entry.second, prefix + entry.first.Scalar(), depth);
    }
  }

  void add(const YAML::Node& node, const std::string& key) {
    const std::size_t line = line_of(node.Mark());
    const auto same_key = [&](const Setting& setting) { return setting.key == key; };
    const auto first = std::find_if(settings_.begin(), settings_.end(), same_key);
    if (first != settings_.end()) {
      text_->fail(line, "'" + key + "' appears twice, first in line " + std::to_string(first->line));
    }
    settings_.push_back({key, node.Scalar(), text_->name, line});
  }

  const Text* text_;
  std::size_t entries_ = 0;
  std::vector<Setting> settings_;
};

}  // namespace

std::vector<Setting> parse_config(const Text& text) {
  ConfigReader reader(text);
  try {
    reader.read(YAML::Load(text.content), "");
  } catch (const YAML::Exception& error) {
    text.fail(line_of(error.mark), "not valid YAML: " + error.msg);
  }
  return reader.settings();
}

Setting parse_set_option(const std::string& text) {
  const std::string origin = "--set " + text;
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw InputError(origin, 0, "expected name=value");
  return {text.substr(0, equals), text.substr(equals + 1), origin, 0};
}

std::vector<Setting> collect_settings(const std::string& config_path,
                                      const std::vector<std::string>& set_options) {
  std::vector<Setting> settings;
  if (!config_path.empty()) settings = parse_config(read_text(config_path));
  for (const auto& option : set_options) settings.push_back(parse_set_option(option));
  return settings;
}

}  // namespace radioslam::cli
