// Access to parameters by name: sets the fields of a parameter struct from text, and lists them with unit,
// range and default. A struct names its fields with visit_fields (base/fields.hpp); a struct of such structs
// names its sections:
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
#include <variant>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/input_error.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam::cli {

/// One parameter setting as the user wrote it.
struct Setting {
  std::string key;
  std::string value;
  std::string origin;    ///< file name, or the option as typed
  std::size_t line = 0;  ///< line in the file; 0 for an option
};

/// One entry of the parameter list.
struct ParameterDescription {
  std::string key;
  std::string unit;
  std::string range;
  std::string default_value;
  std::string description;
  Field::Level level = Field::Level::kExpert;
};

/// One parameter of a struct: its key, its field and where its value is.
struct ParameterRef {
  std::string key;
  Field field;
  std::variant<double*, int*, bool*, std::string*> value;
};

/// Collects the parameters of a struct. One small visitor for everything that is done with parameters keeps
/// the several hundred fields from being compiled once per purpose.
class ParameterCollector {
 public:
  explicit ParameterCollector(std::vector<ParameterRef>& parameters) : parameters_(parameters) {}

  void operator()(const Field& field, double& value) { add(field, &value); }
  void operator()(const Field& field, int& value) { add(field, &value); }
  void operator()(const Field& field, bool& value) { add(field, &value); }
  void operator()(const Field& field, std::string& value) { add(field, &value); }

  template <class Section>
  void operator()(std::string_view name, Section& section) {
    const std::size_t outer = prefix_.size();
    prefix_.append(name).append(1, '.');
    collect(section);
    prefix_.resize(outer);
  }

  template <class Params>
  void collect(Params& params) {
    if constexpr (requires(ParameterCollector & visit) { Params::visit_fields(params, visit); })
      Params::visit_fields(params, *this);
    if constexpr (requires(ParameterCollector & visit) { Params::visit_sections(params, visit); })
      Params::visit_sections(params, *this);
  }

 private:
  void add(const Field& field, std::variant<double*, int*, bool*, std::string*> value);

  std::vector<ParameterRef>& parameters_;
  std::string prefix_;
};

/// Every parameter of `params`, in the order of visit_fields and visit_sections; `params` must outlive them.
template <class Params>
std::vector<ParameterRef> parameters_in(Params& params) {
  std::vector<ParameterRef> parameters;
  ParameterCollector(parameters).collect(params);
  return parameters;
}

/// Parses the setting's text as a value of the field. Throws InputError if it is malformed or out of range.
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

/// The shortest text that parse_value reads back as the same value.
std::string value_text(double value);
std::string value_text(int value);
std::string value_text(bool value);
std::string value_text(const std::string& value);

/// Applies the settings in order, so the last one for a key wins. Throws InputError for an unknown key,
/// suggesting similar ones, and for a value that is malformed or out of range.
void apply_settings(const std::vector<ParameterRef>& parameters, const std::vector<Setting>& settings);

/// The values in use; those that differ from `defaults`, the same parameters, are marked as changed.
std::vector<EffectiveParameter> effective_parameters(const std::vector<ParameterRef>& parameters,
                                                     const std::vector<ParameterRef>& defaults);

std::vector<ParameterDescription> describe_parameters(const std::vector<ParameterRef>& defaults);

template <class Params>
Params with_settings(Params params, const std::vector<Setting>& settings) {
  apply_settings(parameters_in(params), settings);
  return params;
}

template <class Params>
std::vector<EffectiveParameter> effective_parameters(Params params) {
  Params defaults{};
  return effective_parameters(parameters_in(params), parameters_in(defaults));
}

template <class Params>
std::vector<ParameterDescription> describe_parameters() {
  Params defaults{};
  return describe_parameters(parameters_in(defaults));
}

/// The list as text, two lines per parameter.
std::string parameter_list_text(const std::vector<ParameterDescription>& parameters);

}  // namespace radioslam::cli
