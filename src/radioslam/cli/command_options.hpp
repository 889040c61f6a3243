// Options that several commands share.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <string>
#include <vector>

namespace radioslam::cli {

/// Where the parameters of a command come from.
struct ParameterOptions {
  std::string config_path;
  std::vector<std::string> set;
};

/// `-o, --output`, required; `what` names it in the help.
void add_output_option(CLI::App& command, std::string& path, const std::string& what);

/// `--set key=value`, once per parameter.
void add_set_option(CLI::App& command, std::vector<std::string>& set);

/// `--config FILE` and `--set section.key=value`.
void add_parameter_options(CLI::App& command, ParameterOptions& options);

/// `--json`: one object on standard output and nothing else there.
void add_json_option(CLI::App& command, bool& json);

/// Refuses what is no finite number from `minimum` to `maximum` (CLI::Range lets NaN pass).
CLI::Validator number_from(double minimum, double maximum);

/// Refuses what is no whole number from 0 to 2^64 - 1 (a minus sign would wrap around).
CLI::Validator seed_number();

/// `--threads N`: takes effect when the command line is read.
void add_threads_option(CLI::App& command);

/// `--set a=1 b=2` means `--set a=1 --set b=2`: puts the option before every further name=value.
std::vector<std::string> expand_set_options(const std::vector<std::string>& arguments);

}  // namespace radioslam::cli
