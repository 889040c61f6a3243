// Parameter settings from a configuration file and from `--set section.key=value`; later settings win.
#pragma once

#include <string>
#include <vector>

#include "radioslam/cli/parameters.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam::cli {

/// Reads the settings of a YAML configuration file, which has one map per section:
///   keyframe:
///     distance_m: 2
/// Throws InputError for any other structure and for a key that appears twice.
std::vector<Setting> parse_config(const Text& text);

/// Parses "section.key=value". Throws InputError if the key or the equals sign is missing.
Setting parse_set_option(const std::string& text);

/// The settings of the file (if a path is given), followed by those of the options.
std::vector<Setting> collect_settings(const std::string& config_path,
                                      const std::vector<std::string>& set_options);

}  // namespace radioslam::cli
