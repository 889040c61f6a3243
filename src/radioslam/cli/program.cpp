#include "radioslam/cli/program.hpp"

#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/suggestion.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"

namespace radioslam::cli {
namespace {

constexpr std::size_t kHelpColumn = 30;

constexpr const char* kDescription =
    "radioslam estimates the joint trajectory of a robot team from LiDAR, IMU, odometry and radio "
    "measurements\n"
    "(WiFi fingerprints, ranges, angles of arrival).";

constexpr const char* kProgramFooter =
    "Quick start:\n"
    "  radioslam simulate carpark -o carpark          # two robots with odometry and WiFi scans\n"
    "  radioslam run carpark -o carpark-out           # all trajectories in one frame, and report.html\n"
    "  radioslam evaluate carpark-out carpark         # trajectory errors against the ground truth\n\n"
    "`radioslam COMMAND --help` describes a command.\n"
    "Exit status: 0 success; 1 internal error; 2 invalid command line or input; 130 interrupted.";

constexpr AddCommand kCommands[] = {
    add_simulate, add_run,        add_team,    add_agent,      add_prune,     add_doctor,
    add_log,      add_map,        add_poses,   add_evaluate,   add_import,    add_optimize,
    add_aoa,      add_similarity, add_anchors, add_rendezvous, add_reproduce, add_parameters};

void prepare(CLI::App& program, std::span<const AddCommand> commands) {
  program.name("radioslam");
  program.description(kDescription);
  program.footer(kProgramFooter);
  program.set_version_flag("--version", "radioslam " RADIOSLAM_VERSION, "Print the version");
  program.get_formatter()->column_width(kHelpColumn);
  program.require_subcommand(0, 1);
  add_threads_option(program);
  for (const AddCommand add : commands) add(program);
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const auto* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const auto* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string unknown_command(const CLI::App& program, const std::string& name) {
  return "unknown command '" + name + "'" + did_you_mean(name, command_names(program)) +
         " (`radioslam --help` lists all commands)";
}

std::string unexpected_argument(const CLI::App& command, const std::string& argument) {
  const bool is_option = argument.size() > 1 && argument.front() == '-';
  if (!is_option) return command.get_name() + ": unexpected argument '" + argument + "'";
  const std::string name = argument.substr(0, argument.find('='));
  return command.get_name() + ": unknown option '" + name + "'" + did_you_mean(name, option_names(command));
}

/// The error in the command line, as one line.
std::string call_error(const CLI::App& program, const CLI::ParseError& error) {
  const auto parsed = program.get_subcommands();
  const CLI::App& command = parsed.empty() ? program : *parsed.front();
  const auto left_over = program.remaining(true);
  std::string text = !left_over.empty() ? unexpected_argument(command, left_over.front())
                                        : command.get_name() + ": " + error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

int fail(int status, const std::string& reason) {
  std::cerr << (reason.starts_with("radioslam") ? "" : "radioslam: ") << reason << '\n';
  return status;
}

/// Whether the reader of standard output has closed its end of the pipe.
bool stdout_is_closed() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0;
}

/// Reports output that could not be written, unless the reader closed the pipe (as `head` does).
int finish_output() {
  std::cout.flush();
  if (std::cout.good() || stdout_is_closed()) return kDone;
  return fail(kOurFailure, "cannot write to standard output");
}

int parse_and_run(CLI::App& program, std::vector<std::string> arguments) {
  std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
  try {
    program.parse(arguments);
  } catch (const CLI::Success& wanted) {  // help or version
    program.exit(wanted);
  } catch (const CLI::ParseError& error) {
    return fail(kWrongInput, call_error(program, error));
  } catch (const InputError& error) {
    return fail(kWrongInput, error.what());
  } catch (const std::exception& error) {
    return fail(kOurFailure, std::string("internal error: ") + error.what());
  }
  return finish_output();
}

}  // namespace

int run_program(std::span<const AddCommand> commands, const std::vector<std::string>& arguments) {
  CLI::App program;
  prepare(program, commands);
  if (arguments.empty()) {
    std::cout << program.help();
    return finish_output();
  }
  const auto names = command_names(program);
  const std::string& first = arguments.front();
  const bool is_command = std::find(names.begin(), names.end(), first) != names.end();
  if (!is_command && !first.starts_with("-")) return fail(kWrongInput, unknown_command(program, first));
  return parse_and_run(program, expand_set_options(arguments));
}

int run_program(const std::vector<std::string>& arguments) { return run_program(kCommands, arguments); }

}  // namespace radioslam::cli
