// The whole program, from its arguments to its exit status.
#pragma once

#include <string>
#include <vector>

namespace radioslam::cli {

/// Runs the command that the arguments (without the program's own name) ask for. Errors become one line on
/// standard error and a status of exit_status.hpp.
int run_program(const std::vector<std::string>& arguments);

}  // namespace radioslam::cli
