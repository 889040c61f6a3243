// radioslam reproduce: starts the program radioslam-reproduce, which has the studies and is built by itself.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/cli/commands.hpp"

namespace radioslam::cli {
namespace {

constexpr const char* kProgram = "radioslam-reproduce";

/// Becomes the program beside this one. Refuses (InputError) where there is none.
[[noreturn]] void become_program_of_studies(std::vector<std::string> arguments) {
  const auto path = std::filesystem::read_symlink("/proc/self/exe").parent_path() / kProgram;
  std::vector<char*> words{const_cast<char*>(path.c_str())};
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  execv(path.c_str(), words.data());
  throw InputError(
      "reproduce", 0,
      "needs the program " + path.string() +
          ", which is built by itself: cmake --build build/release --target radioslam_reproduce");
}

}  // namespace

void add_reproduce(CLI::App& program) {
  auto* command =
      program.add_subcommand("reproduce", "Reproduce a published table, or run one of the project's studies");
  command->set_help_flag();  // the other program answers --help
  command->prefix_command();
  command->callback([&program, command] {
    std::vector<std::string> arguments = command->remaining();
    const auto* threads = program.get_option("--threads");
    if (threads->count() > 0 && std::find(arguments.begin(), arguments.end(), "--threads") == arguments.end())
      arguments.insert(arguments.end(), {"--threads", threads->as<std::string>()});
    become_program_of_studies(std::move(arguments));
  });
}

}  // namespace radioslam::cli
