// Subcommands that are programs of their own, beside this one: radioslam-reproduce has the studies, which
// take long to build; radioslam-agent uses DDS, which takes long to load.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/cli/commands.hpp"

namespace radioslam::cli {
namespace {

/// Becomes radioslam-COMMAND. Refuses (InputError) where there is none.
[[noreturn]] void become_program(const std::string& command, std::vector<std::string> arguments) {
  const auto path = std::filesystem::read_symlink("/proc/self/exe").parent_path() / ("radioslam-" + command);
  std::vector<char*> words{const_cast<char*>(path.c_str())};
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  execv(path.c_str(), words.data());
  throw InputError(command, 0,
                   "needs the program " + path.string() +
                       ", which is built by itself: cmake --build build/release --target radioslam_" +
                       command);
}

void add_program(CLI::App& program, const std::string& name, const std::string& description) {
  auto* command = program.add_subcommand(name, description);
  command->set_help_flag();  // the other program answers --help
  command->prefix_command();
  command->callback([&program, command] {
    std::vector<std::string> arguments = command->remaining();
    const auto* threads = program.get_option("--threads");
    if (threads->count() > 0 && std::find(arguments.begin(), arguments.end(), "--threads") == arguments.end())
      arguments.insert(arguments.end(), {"--threads", threads->as<std::string>()});
    become_program(command->get_name(), std::move(arguments));
  });
}

}  // namespace

void add_reproduce(CLI::App& program) {
  add_program(program, "reproduce", "Reproduce a published table, or run one of the project's studies");
}

void add_agent(CLI::App& program) {
  add_program(program, "agent", "Run one robot of a team, which talks to the others by DDS");
}

}  // namespace radioslam::cli
