// What `radioslam import` was called with, and what its kinds of sources have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "radioslam/cli/command_options.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"

namespace radioslam::cli {

struct ImportOptions {
  std::string kind;
  std::vector<std::string> sources;
  std::string output;
  std::string robot;                ///< where there is one
  std::vector<std::string> robots;  ///< all of them
  std::vector<std::string> names;
  std::string fields;
  std::string time;
  std::vector<std::string> poses;
  std::vector<std::string> odometry, scans, imu, gnss, truth;  ///< topics
  bool file_times = false;
  bool list = false;
  ParameterOptions parameters;
};

template <class Params>
Params params_of(const ImportOptions& options) {
  return with_settings(Params{}, collect_settings(options.parameters.config_path, options.parameters.set));
}

/// The source of a kind that takes one.
inline const std::string& only_source(const ImportOptions& options) {
  if (options.sources.size() != 1)
    throw InputError("import " + options.kind, 0,
                     "takes one source, " + std::to_string(options.sources.size()) + " are given");
  return options.sources.front();
}

/// Adds what a call of `import` can say.
void add_import_options(CLI::App& command, ImportOptions& options);

/// Refuses what cannot name a robot or an anchor; `option` is how it was given.
void check_import_id(const std::string& option, const std::string& id);

}  // namespace radioslam::cli
