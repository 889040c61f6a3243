// Options shared by several commands.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <string>
#include <vector>

#include "radioslam/io/graph/team_graph_file.hpp"

namespace radioslam::cli {

/// The options that set a command's parameters.
struct ParameterOptions {
  std::string config_path;
  std::vector<std::string> set;
};

/// `-o, --output`, required; `what` is its help text.
void add_output_option(CLI::App& command, std::string& path, const std::string& what);

/// `--set key=value`, once per parameter.
void add_set_option(CLI::App& command, std::vector<std::string>& set);

/// `--config FILE` and `--set section.key=value`.
void add_parameter_options(CLI::App& command, ParameterOptions& options);

/// `--json`: print one JSON object on standard output and nothing else.
void add_json_option(CLI::App& command, bool& json);

/// Accepts finite numbers from `minimum` to `maximum` (CLI::Range accepts NaN).
CLI::Validator number_from(double minimum, double maximum);

/// Accepts whole numbers from 0 to 2^64 - 1 (without it, a negative number would wrap around).
CLI::Validator seed_number();

/// MISSION: one path, or several graphs.
void add_mission_option(CLI::App& command, std::vector<std::string>& paths);

/// `--known-starts`; sets `starts` when the command line is parsed.
void add_known_starts_option(CLI::App& command, StatedStarts& starts);

/// `--threads N`; takes effect when the command line is parsed.
void add_threads_option(CLI::App& command);

/// Expands `--set a=1 b=2` to `--set a=1 --set b=2`.
std::vector<std::string> expand_set_options(const std::vector<std::string>& arguments);

}  // namespace radioslam::cli
