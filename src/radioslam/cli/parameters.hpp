// Parameters by name: texts into the fields of a parameter struct, and the fields into lists.
// A struct names its fields with visit_fields (base/fields.hpp); a struct of such structs names its sections:
//
//   template <class Self, class Visitor>
//   static void visit_sections(Self& self, Visitor&& visit) {
//     visit("keyframe", self.keyframe);
//   }
//
// A parameter's key is "section.field", or "field" where there are no sections.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/input_error.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam::cli {

/// A parameter as somebody wrote it.
struct Setting {
  std::string key;
  std::string value;
  std::string place;     ///< the file, or the option as it was typed
  std::size_t line = 0;  ///< in the file; 0 for an option
};

/// One row of the list of parameters.
struct ParameterDescription {
  std::string key;
  std::string unit;
  std::string range;
  std::string default_value;
  std::string meaning;
};

template <class Params>
concept HasSections = requires(Params& params) {
  Params::visit_sections(params, [](std::string_view, auto&) {});
};

template <class Params>
concept HasFields = requires(Params& params) {
  Params::visit_fields(params, [](const Field&, auto&) {});
};

/// Calls visit(key, field, value) for every parameter, in the order of the lists.
template <class Params, class Visitor>
void for_each_parameter(Params& params, const Visitor& visit, const std::string& prefix = {}) {
  using Plain = std::remove_const_t<Params>;
  if constexpr (HasFields<Plain>) {
    Plain::visit_fields(params, [&](const Field& field, auto& value) {
      visit(prefix + std::string(field.name), field, value);
    });
  }
  if constexpr (HasSections<Plain>) {
    Plain::visit_sections(params, [&](std::string_view name, auto& section) {
      for_each_parameter(section, visit, prefix + std::string(name) + ".");
    });
  }
}

/// The text as a value of the field. Throws InputError when it is none or out of range.
template <class Value>
Value parse_value(const Field& field, const Setting& setting);
template <>
double parse_value<double>(const Field& field, const Setting& setting);
template <>
int parse_value<int>(const Field& field, const Setting& setting);
template <>
bool parse_value<bool>(const Field& field, const Setting& setting);
template <>
std::string parse_value<std::string>(const Field& field, const Setting& setting);

/// The shortest text that parse_value reads as the same value.
std::string value_text(double value);
std::string value_text(int value);
std::string value_text(bool value);
std::string value_text(const std::string& value);

/// What a field may be, in words: "0.01 to 1000", "true or false", "cosine, slide".
template <class Value>
std::string range_text(const Field& field);
template <>
std::string range_text<double>(const Field& field);
template <>
std::string range_text<int>(const Field& field);
template <>
std::string range_text<bool>(const Field& field);
template <>
std::string range_text<std::string>(const Field& field);

InputError unknown_parameter(const Setting& setting, const std::vector<std::string>& keys);

template <class Params>
std::vector<std::string> parameter_keys(const Params& params) {
  std::vector<std::string> keys;
  for_each_parameter(params, [&](const std::string& key, const Field&, const auto&) { keys.push_back(key); });
  return keys;
}

/// `params` with the settings applied in order, the last one winning. Throws InputError for a key that does
/// not exist, naming its neighbours, and for a value out of range.
template <class Params>
Params with_settings(Params params, const std::vector<Setting>& settings) {
  for (const auto& setting : settings) {
    bool found = false;
    for_each_parameter(params, [&](const std::string& key, const Field& field, auto& value) {
      if (key != setting.key) return;
      value = parse_value<std::remove_reference_t<decltype(value)>>(field, setting);
      found = true;
    });
    if (!found) throw unknown_parameter(setting, parameter_keys(params));
  }
  return params;
}

/// Every parameter as it is used, with what differs from the defaults marked.
template <class Params>
std::vector<EffectiveParameter> effective_parameters(const Params& params) {
  std::vector<EffectiveParameter> list;
  for_each_parameter(params, [&](const std::string& key, const Field& field, const auto& value) {
    list.push_back({key, value_text(value), std::string(field.unit), std::string(field.meaning), false});
  });
  const Params defaults{};
  std::size_t next = 0;
  for_each_parameter(defaults, [&](const std::string&, const Field&, const auto& value) {
    auto& parameter = list[next++];
    parameter.changed = parameter.value != value_text(value);
  });
  return list;
}

template <class Params>
std::vector<ParameterDescription> describe_parameters() {
  std::vector<ParameterDescription> list;
  const Params defaults{};
  for_each_parameter(defaults, [&](const std::string& key, const Field& field, const auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    list.push_back({key, std::string(field.unit), range_text<Value>(field), value_text(value),
                    std::string(field.meaning)});
  });
  return list;
}

/// The list as text: two lines per parameter.
std::string parameter_list_text(const std::vector<ParameterDescription>& parameters);

}  // namespace radioslam::cli
