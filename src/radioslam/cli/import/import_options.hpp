// Command line options of `radioslam import` and helpers shared by all kinds of sources.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/io/mission/mission_output.hpp"

namespace radioslam::cli {

struct ImportOptions {
  std::string kind;
  std::vector<std::string> sources;
  std::string output;
  std::string robot;                ///< the first of `robots`; empty if none is given
  std::vector<std::string> robots;  ///< every --robot, in order
  std::vector<std::string> names;
  std::string fields;
  std::string time;
  std::vector<std::string> poses;
  std::vector<std::string> odometry, scans, imu, gnss, truth, wifi;  ///< names of ROS topics
  std::vector<std::string> ranges;                                   ///< TOPIC=ID,ID
  bool file_times = false;
  bool list = false;
  bool replace = false;
  ParameterOptions parameters;
};

/// Options that only some kinds of source take.
enum class ImportOption { kRobot, kRobots, kName, kFields, kTime, kPoses, kTopics, kParameters };

template <class Params>
Params params_of(const ImportOptions& options) {
  return with_settings(Params{}, collect_settings(options.parameters.config_path, options.parameters.set));
}

/// The source, for kinds that take exactly one.
inline const std::string& only_source(const ImportOptions& options) {
  if (options.sources.size() != 1)
    throw InputError("import " + options.kind, 0,
                     "takes one source, but " + std::to_string(options.sources.size()) + " are given");
  return options.sources.front();
}

/// What happens to recordings that the output has.
inline MissionOutput::Existing existing_of(const ImportOptions& options) {
  return options.replace ? MissionOutput::Existing::kReplace : MissionOutput::Existing::kKeep;
}

/// Adds the options that all kinds take: sources, output, --replace and threads.
void add_common_options(CLI::App& command, ImportOptions& options);

/// Adds the options of this name or group of names.
void add_import_option(CLI::App& command, ImportOptions& options, ImportOption option);

/// Adds the options of all kinds; only the common ones appear in the help of `command`.
void add_all_import_options(CLI::App& command, ImportOptions& options);

/// Refuses (InputError) every given option that is not among `taken`.
void refuse_other_options(const ImportOptions& options, const std::vector<ImportOption>& taken);

/// The robot of a mission that one recording is of: the one that --robot names, or the mission's only one, or
/// one of a new mission that is named after the first source. Refuses (InputError) invalid names, and a
/// mission of several robots without --robot.
struct ImportedRobot {
  std::string id;
  bool is_added = false;  ///< to a mission that is there
};
ImportedRobot robot_of_import(const ImportOptions& options);

/// The notes on a robot that importers of one table write: that it is new, and that its odometry is missing.
std::vector<std::string> notes_on(const ImportOptions& options, const ImportedRobot& robot);

/// Refuses (InputError) a table that is there and lies in a mission, unless --replace is given.
void refuse_table_of_mission(const ImportOptions& options);

/// Refuses (InputError) an invalid name of a robot or an anchor; `option` prefixes the message.
void check_import_id(const std::string& option, const std::string& id);

/// a, b and so on; none for more than there are letters.
std::vector<std::string> robot_letters(std::size_t count);

/// The robots' names in the order of the sources: those of --robot, or else `otherwise`. Refuses (InputError)
/// another number than that of the sources, invalid names and names that occur twice.
std::vector<std::string> robots_of_import(const ImportOptions& options, std::size_t sources,
                                          std::vector<std::string> otherwise);

/// The value for source k of an option that may be given once for all sources, or once per source.
std::string value_for(const std::vector<std::string>& values, const char* option, std::size_t k,
                      std::size_t sources);

}  // namespace radioslam::cli
