#include "radioslam/cli/agent/command_agent.hpp"
#include "radioslam/cli/ending.hpp"
#include "radioslam/cli/freed_memory.hpp"
#include "radioslam/cli/program.hpp"

/// radioslam-agent ...: what `radioslam agent ...` starts.
int main(int argc, char** argv) {
  using namespace radioslam::cli;
  keep_freed_memory();
  end_cleanly();
  std::vector<std::string> arguments{argv + 1, argv + argc};
  arguments.insert(arguments.begin(), "agent");
  constexpr AddCommand kCommands[] = {add_agent_options};
  return run_program(kCommands, arguments);
}
