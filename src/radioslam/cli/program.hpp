// The command line program, from its arguments to its exit status.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace radioslam::cli {

// Exit statuses of the program.
constexpr int kDone = 0;
constexpr int kOurFailure = 1;     ///< internal error, or a failure of the system
constexpr int kWrongInput = 2;     ///< invalid command line or input
constexpr int kInterrupted = 130;  ///< ended by a signal; outputs are unchanged

/// Registers a subcommand with its options and its action.
using AddCommand = void (*)(CLI::App& program);

/// Runs the subcommand that the arguments (without the program's name) select. An error is printed as one
/// line on standard error. Returns an exit status.
int run_program(std::span<const AddCommand> commands, const std::vector<std::string>& arguments);

/// The same with all subcommands of `radioslam`.
int run_program(const std::vector<std::string>& arguments);

}  // namespace radioslam::cli
