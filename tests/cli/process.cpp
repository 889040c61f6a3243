#include "cli/process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

void send_output_to(const fs::path& path, int descriptor) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(file, descriptor);
  close(file);
}

[[noreturn]] void become_program(const std::vector<std::string>& arguments, const fs::path& folder,
                                 const fs::path& output) {
  send_output_to(output / "out", STDOUT_FILENO);
  send_output_to(output / "err", STDERR_FILENO);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  std::signal(SIGINT, SIG_DFL);
  std::vector<std::string> words{RADIOSLAM_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  if (chdir(folder.c_str()) == 0) execv(RADIOSLAM_PROGRAM, pointers.data());
  _exit(127);
}

}  // namespace

Outcome run(const std::vector<std::string>& arguments, const fs::path& folder,
            std::optional<Interruption> interruption) {
  const TemporaryFolder output;
  const pid_t child = fork();
  if (child == 0) become_program(arguments, folder, output.path());
  if (interruption) {
    std::this_thread::sleep_for(std::chrono::duration<double>(interruption->after_s));
    kill(child, interruption->signal);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(output.path() / "out"),
          read_file(output.path() / "err")};
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "radioslam-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string read_file(const fs::path& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

void write_file(const fs::path& path, const std::string& content) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace radioslam::cli
