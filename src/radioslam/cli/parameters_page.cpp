#include "radioslam/cli/parameters_page.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "radioslam/cli/parameter_sets.hpp"

namespace radioslam::cli {
namespace {

using Descriptions = std::vector<ParameterDescription>;

constexpr std::string_view kOpening =
    "# Parameters\n\n"
    "`--set name=value` and `--config FILE` (YAML, one map per section) change them; `radioslam parameters\n"
    "COMMAND` lists them. The basic ones come first; the defaults of the others are meant to be kept.\n"
    "This page is written by `scripts/parameters_page.sh`.\n";

std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string name_with_unit(const ParameterDescription& parameter) {
  return parameter.default_value + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

std::string table(const Descriptions& parameters) {
  std::string text = "\n| parameter | default | range | meaning |\n| --- | --- | --- | --- |\n";
  for (const ParameterDescription& parameter : parameters)
    text += "| `" + parameter.key + "` | " + cell(name_with_unit(parameter)) + " | " + cell(parameter.range) +
            " | " + cell(parameter.description) + " |\n";
  return text;
}

std::string_view section_of(const ParameterDescription& parameter) {
  const std::size_t dot = parameter.key.rfind('.');
  return std::string_view(parameter.key).substr(0, dot == std::string::npos ? 0 : dot);
}

/// One table per section, in the program's order.
std::string sections(const Descriptions& parameters) {
  std::string text;
  for (auto begin = parameters.begin(); begin != parameters.end();) {
    const std::string_view section = section_of(*begin);
    const auto end = std::find_if(begin, parameters.end(), [&](const ParameterDescription& parameter) {
      return section_of(parameter) != section;
    });
    if (!section.empty()) text += "\n### " + std::string(section) + "\n";
    text += table(Descriptions(begin, end));
    begin = end;
  }
  return text;
}

/// A call with parameters of its own.
std::string chapter(const ParameterSet& set) {
  const Descriptions parameters = describe_parameters(set.defaults().parameters);
  const Descriptions basic = basic_parameters(parameters);
  std::string text = "\n## " + std::string(set.call) + "\n";
  if (basic.size() < parameters.size()) {
    text += "\n### Basic parameters of " + std::string(set.call) + "\n" + table(basic);
    if (section_of(parameters.front()).empty())
      text += "\n### All parameters of " + std::string(set.call) + "\n";
  }
  return text + sections(parameters);
}

/// "- `reproduce aoa`: as `aoa`", with the defaults that differ.
std::string reference(const ParameterSet& set) {
  const Descriptions own = describe_parameters(set.defaults().parameters);
  const Descriptions other = describe_parameters(parameter_set(std::string(set.like)).defaults().parameters);
  std::string differences;
  for (std::size_t k = 0; k < own.size(); ++k)
    if (own[k].default_value != other[k].default_value)
      differences +=
          (differences.empty() ? ", but with " : ", ") + ("`" + own[k].key + "` = ") + name_with_unit(own[k]);
  return "- `" + std::string(set.call) + "`: as `" + std::string(set.like) + "`" + differences + "\n";
}

}  // namespace

std::string parameters_page() {
  std::string chapters, references = "\n## Calls with the parameters of others\n\n";
  for (const ParameterSet& set : parameter_sets()) {
    if (set.defaults == nullptr) continue;
    if (set.like.empty())
      chapters += chapter(set);
    else if (!set.like.starts_with(std::string(set.call) + " "))  // "simulate" needs a scenario
      references += reference(set);
  }
  return std::string(kOpening) + chapters + references;
}

}  // namespace radioslam::cli
