// The command line program, from its arguments to its exit status.
#pragma once

#include <string>
#include <vector>

namespace radioslam::cli {

// Exit statuses of the program.
constexpr int kDone = 0;
constexpr int kOurFailure = 1;     ///< internal error, or a failure of the system
constexpr int kWrongInput = 2;     ///< invalid command line or input
constexpr int kInterrupted = 130;  ///< ended by a signal; outputs are unchanged

/// Runs the subcommand that the arguments (without the program's name) select. An error is printed as one
/// line on standard error. Returns an exit status.
int run_program(const std::vector<std::string>& arguments);

}  // namespace radioslam::cli
