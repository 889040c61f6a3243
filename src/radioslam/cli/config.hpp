// Where settings come from: a configuration file, then `--set section.key=value`, the later winning.
#pragma once

#include <string>
#include <vector>

#include "radioslam/cli/parameters.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam::cli {

/// The settings of a configuration file: YAML, a map per section, values as texts.
///   keyframe:
///     distance_m: 2
/// Throws InputError for what is not such a file and for a key given twice.
std::vector<Setting> parse_config(const Text& text);

/// "section.key=value". Throws InputError when there is no key or no equals sign.
Setting parse_set_option(const std::string& text);

/// The file's settings (none without a file), then the options'.
std::vector<Setting> collect_settings(const std::string& config_path,
                                      const std::vector<std::string>& set_options);

}  // namespace radioslam::cli
