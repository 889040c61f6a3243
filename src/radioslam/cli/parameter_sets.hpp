// The parameters of every command, scenario, kind of import and table of the program, by name.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/cli/parameters.hpp"

namespace radioslam::cli {

/// The default parameters of a command, which can be changed by name.
struct DefaultParameters {
  std::shared_ptr<void> values;  ///< what `parameters` refer to
  std::vector<ParameterRef> parameters;
};

/// What a call of the program takes by --set and --config.
struct ParameterSet {
  std::string_view call;                      ///< "run", "simulate city", "import iw", "reproduce aoa"
  DefaultParameters (*defaults)() = nullptr;  ///< null for a call without parameters
  std::string_view like = {};                 ///< the call with the same names, in the list before this one
  std::string_view reason = {};               ///< why there are no parameters

  /// "city" for "simulate city"
  std::string_view name() const { return call.substr(call.rfind(' ') + 1); }
};

/// All commands that take --set, with every scenario, kind of import and table.
std::span<const ParameterSet> parameter_sets();

/// The set with this call, or else the first with this name. Throws InputError for an unknown name,
/// suggesting similar ones, and for a call without parameters.
const ParameterSet& parameter_set(const std::string& name);

/// The basic ones of a call's parameters; all of them where the list is short or none is basic.
std::vector<ParameterDescription> basic_parameters(const std::vector<ParameterDescription>& parameters);

// The page docs/parameters.md: every parameter of every command, as tables in Markdown.

/// For each call of the program its basic parameters, then all of them by section.
std::string parameters_page();

}  // namespace radioslam::cli
