#include "radioslam/cli/commands/command_options.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>

#include "radioslam/base/parallel.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

constexpr int kMaxThreads = 1024;

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

/// Whether the argument is name=value with a valid parameter name, as opposed to a path or an option.
bool is_assignment(const std::string& argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || equals == 0) return false;
  return std::all_of(argument.begin(), argument.begin() + static_cast<std::ptrdiff_t>(equals),
                     is_name_character);
}

}  // namespace

void add_output_option(CLI::App& command, std::string& path, const std::string& what) {
  command.add_option("-o,--output", path, what)->required()->type_name("PATH");
}

void add_set_option(CLI::App& command, std::vector<std::string>& set) {
  command.add_option("--set", set, "Set a parameter; may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

void add_parameter_options(CLI::App& command, ParameterOptions& options) {
  command
      .add_option("--config", options.config_path,
                  "Read parameters from a YAML file with one map per section")
      ->type_name("FILE");
  add_set_option(command, options.set);
}

void add_json_option(CLI::App& command, bool& json) {
  command.add_flag("--json", json,
                   "Print the result as one JSON object on standard output, and nothing else");
}

CLI::Validator number_from(double minimum, double maximum) {
  const auto check = [minimum, maximum](const std::string& text) {
    const auto number = parse_number(text);
    if (number && minimum <= *number && *number <= maximum) return std::string{};
    return "'" + text + "' is not a number from " + format_number(minimum) + " to " + format_number(maximum);
  };
  return CLI::Validator(check, "");
}

CLI::Validator seed_number() {
  const auto check = [](const std::string& text) {
    if (parse_id(text)) return std::string{};
    return "'" + text + "' is not a whole number from 0 to 2^64 - 1";
  };
  return CLI::Validator(check, "");
}

void add_mission_option(CLI::App& command, std::vector<std::string>& paths) {
  command
      .add_option(
          "MISSION", paths,
          "Mission folder (with mission.yaml), or a factor graph (.g2o, .pyfg or .jrl; also .zst): one "
          "file, or a folder or list of g2o files, one per robot; or logs of robots (.rslog, `run --log`)")
      ->required();
}

void add_known_starts_option(CLI::App& command, StatedStarts& starts) {
  command.add_flag_callback(
      "--known-starts", [&starts] { starts = StatedStarts::kUsed; },
      "Take the starts that a factor graph states (priors, or the VERTEX lines of a g2o file) as known");
}

void add_threads_option(CLI::App& command) {
  command
      .add_option_function<int>(
          "--threads", [](int threads) { set_thread_count(static_cast<std::size_t>(threads)); },
          "Number of threads (default: all cores); results do not depend on it")
      ->check(CLI::Range(1, kMaxThreads))
      ->type_name("N");
}

std::vector<std::string> expand_set_options(const std::vector<std::string>& arguments) {
  std::vector<std::string> expanded;
  bool within_set = false;
  for (const auto& argument : arguments) {
    const bool follows_set = !expanded.empty() && expanded.back() == "--set";
    if (within_set && !follows_set && is_assignment(argument)) expanded.emplace_back("--set");
    within_set = argument == "--set" || (within_set && is_assignment(argument));
    expanded.push_back(argument);
  }
  return expanded;
}

}  // namespace radioslam::cli
