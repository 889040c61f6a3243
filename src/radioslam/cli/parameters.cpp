#include "radioslam/cli/parameters.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/suggestion.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

std::string with_unit(const std::string& text, const Field& field) {
  return field.unit.empty() ? text : text + " " + std::string(field.unit);
}

InputError refused(const Setting& setting, const std::string& expected) {
  const std::string written = setting.line > 0 ? setting.key + ": " + setting.value : setting.value;
  return InputError(setting.origin, setting.line, "'" + written + "' is not " + expected);
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

std::string join(const std::vector<std::string>& parts, std::string_view separator) {
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? std::string{} : std::string(separator)) + part;
  return text;
}

bool in_range(double number, const Field& field) {
  return number >= field.minimum && number <= field.maximum;
}

/// "0.01 to 1000"
std::string interval_text(const Field& field) {
  return format_number(field.minimum) + " to " + format_number(field.maximum);
}

std::string range_text(const Field& field, const double*) { return interval_text(field); }
std::string range_text(const Field& field, const int*) { return interval_text(field); }
std::string range_text(const Field&, const bool*) { return "true or false"; }
std::string range_text(const Field& field, const std::string*) {
  return field.choices.empty() ? "any text" : join(split(field.choices, '|'), ", ");
}

/// The values that a parameter allows, in words: "0.01 to 1000", "true or false", "cosine, slide".
std::string range_text(const ParameterRef& parameter) {
  return std::visit([&](const auto* value) { return range_text(parameter.field, value); }, parameter.value);
}

std::string value_text(const ParameterRef& parameter) {
  return std::visit([](const auto* value) { return cli::value_text(*value); }, parameter.value);
}

const ParameterRef* find_parameter(const std::vector<ParameterRef>& parameters, std::string_view key) {
  const auto has_key = [&](const ParameterRef& parameter) { return parameter.key == key; };
  const auto found = std::find_if(parameters.begin(), parameters.end(), has_key);
  return found == parameters.end() ? nullptr : &*found;
}

/// The parameter that the setting names.
const ParameterRef& parameter_named(const std::vector<ParameterRef>& parameters, const Setting& setting) {
  if (const ParameterRef* parameter = find_parameter(parameters, setting.key)) return *parameter;
  std::vector<std::string> keys;
  for (const ParameterRef& parameter : parameters) keys.push_back(parameter.key);
  throw InputError(setting.origin, setting.line,
                   "unknown parameter '" + setting.key + "'" + did_you_mean(setting.key, keys));
}

void apply(const ParameterRef& parameter, const Setting& setting) {
  const auto parse = [&](auto* value) {
    *value = parse_value<std::remove_pointer_t<decltype(value)>>(parameter.field, setting);
  };
  std::visit(parse, parameter.value);
}

}  // namespace

void ParameterCollector::add(const Field& field, std::variant<double*, int*, bool*, std::string*> value) {
  parameters_.push_back({prefix_ + std::string(field.name), field, value});
}

template <>
double parse_value<double>(const Field& field, const Setting& setting) {
  const auto number = parse_number(setting.value);
  if (number && in_range(*number, field)) return *number;
  throw refused(setting, "a number from " + with_unit(interval_text(field), field));
}

template <>
int parse_value<int>(const Field& field, const Setting& setting) {
  const auto number = parse_integer(setting.value);
  if (number && in_range(static_cast<double>(*number), field)) return static_cast<int>(*number);
  throw refused(setting, "a whole number from " + with_unit(interval_text(field), field));
}

template <>
bool parse_value<bool>(const Field&, const Setting& setting) {
  if (setting.value == "true" || setting.value == "yes" || setting.value == "on" || setting.value == "1") {
    return true;
  }
  if (setting.value == "false" || setting.value == "no" || setting.value == "off" || setting.value == "0") {
    return false;
  }
  throw refused(setting, "true or false");
}

template <>
std::string parse_value<std::string>(const Field& field, const Setting& setting) {
  const auto choices = split(field.choices, '|');
  const bool allowed =
      choices.empty() || std::find(choices.begin(), choices.end(), setting.value) != choices.end();
  if (!allowed) throw refused(setting, "one of " + join(choices, ", "));
  return setting.value;
}

std::string value_text(double value) { return format_number(value); }
std::string value_text(int value) { return std::to_string(value); }
std::string value_text(bool value) { return value ? "true" : "false"; }
std::string value_text(const std::string& value) { return value; }

void apply_settings(const std::vector<ParameterRef>& parameters, const std::vector<Setting>& settings) {
  for (const Setting& setting : settings) apply(parameter_named(parameters, setting), setting);
}

std::vector<EffectiveParameter> effective_parameters(const std::vector<ParameterRef>& parameters,
                                                     const std::vector<ParameterRef>& defaults) {
  RADIOSLAM_CHECK(parameters.size() == defaults.size(), "the defaults are those of the same parameters");
  std::vector<EffectiveParameter> list;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const Field& field = parameters[k].field;
    const std::string value = value_text(parameters[k]);
    list.push_back({parameters[k].key, value, std::string(field.unit), std::string(field.description),
                    value != value_text(defaults[k])});
  }
  return list;
}

std::vector<ParameterDescription> describe_parameters(const std::vector<ParameterRef>& defaults) {
  std::vector<ParameterDescription> list;
  for (const ParameterRef& parameter : defaults) {
    const Field& field = parameter.field;
    list.push_back({parameter.key, std::string(field.unit), range_text(parameter), value_text(parameter),
                    std::string(field.description), field.level});
  }
  return list;
}

std::string parameter_list_text(const std::vector<ParameterDescription>& parameters) {
  std::string text;
  for (const auto& parameter : parameters) {
    const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
    text += parameter.key + " = " + parameter.default_value + unit + "   [" + parameter.range + "]\n    " +
            parameter.description + "\n";
  }
  return text;
}

}  // namespace radioslam::cli
