#include "radioslam/cli/parameters.hpp"

#include <algorithm>

#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/numbers.hpp"

namespace radioslam::cli {
namespace {

std::string with_unit(const std::string& text, const Field& field) {
  return field.unit.empty() ? text : text + " " + std::string(field.unit);
}

InputError refused(const Setting& setting, const std::string& expected) {
  const std::string written = setting.line > 0 ? setting.key + ": " + setting.value : setting.value;
  return InputError(setting.place, setting.line, "'" + written + "' is not " + expected);
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

}  // namespace

template <>
double parse_value<double>(const Field& field, const Setting& setting) {
  const auto number = parse_number(setting.value);
  if (number && in_range(*number, field)) return *number;
  throw refused(setting, "a number from " + with_unit(range_text<double>(field), field));
}

template <>
int parse_value<int>(const Field& field, const Setting& setting) {
  const auto number = parse_integer(setting.value);
  if (number && in_range(static_cast<double>(*number), field)) return static_cast<int>(*number);
  throw refused(setting, "a whole number from " + with_unit(range_text<int>(field), field));
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

template <>
std::string range_text<double>(const Field& field) {
  return format_number(field.minimum) + " to " + format_number(field.maximum);
}

template <>
std::string range_text<int>(const Field& field) {
  return range_text<double>(field);
}

template <>
std::string range_text<bool>(const Field&) {
  return "true or false";
}

template <>
std::string range_text<std::string>(const Field& field) {
  return field.choices.empty() ? "any text" : join(split(field.choices, '|'), ", ");
}

InputError unknown_parameter(const Setting& setting, const std::vector<std::string>& keys) {
  return InputError(setting.place, setting.line,
                    "there is no parameter '" + setting.key + "'" + did_you_mean(setting.key, keys));
}

std::string parameter_list_text(const std::vector<ParameterDescription>& parameters) {
  std::string text;
  for (const auto& parameter : parameters) {
    const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
    text += parameter.key + " = " + parameter.default_value + unit + "   [" + parameter.range + "]\n    " +
            parameter.meaning + "\n";
  }
  return text;
}

}  // namespace radioslam::cli
