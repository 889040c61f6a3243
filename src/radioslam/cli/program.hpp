// The command line program, from its arguments to its exit status.
#pragma once

#include <string>
#include <vector>

namespace radioslam::cli {

/// Runs the subcommand that the arguments (without the program's name) select. An error is printed as one
/// line on standard error. Returns a status of exit_status.hpp.
int run_program(const std::vector<std::string>& arguments);

}  // namespace radioslam::cli
