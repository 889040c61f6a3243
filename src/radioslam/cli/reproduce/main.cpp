#include "radioslam/cli/ending.hpp"
#include "radioslam/cli/program.hpp"
#include "radioslam/cli/reproduce/command_reproduce.hpp"

/// radioslam-reproduce TABLE ...: what `radioslam reproduce TABLE ...` starts.
int main(int argc, char** argv) {
  using namespace radioslam::cli;
  end_cleanly();
  std::vector<std::string> arguments{argv + 1, argv + argc};
  arguments.insert(arguments.begin(), "reproduce");
  constexpr AddCommand kCommands[] = {add_tables};
  return run_program(kCommands, arguments);
}
