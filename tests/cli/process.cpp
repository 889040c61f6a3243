#include "cli/process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
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
  Started program(arguments, folder);
  if (interruption) {
    std::this_thread::sleep_for(std::chrono::duration<double>(interruption->after_s));
    program.signal(interruption->signal);
  }
  return program.wait();
}

Started::Started(const std::vector<std::string>& arguments, const fs::path& folder)
    : output_(std::make_unique<TemporaryFolder>()), process_(fork()) {
  if (process_ == 0) become_program(arguments, folder, output_->path());
}

Started::~Started() {
  if (!has_ended()) signal(SIGKILL);
  wait();
}

bool Started::has_ended() {
  int status = 0;
  if (!status_ && waitpid(process_, &status, WNOHANG) == process_) status_ = status;
  return status_.has_value();
}

void Started::signal(int number) const {
  if (!status_) kill(process_, number);
}

bool Started::says(const std::string& text) {
  for (;;) {
    const bool ended = has_ended();
    if (read_file(output_->path() / "out").find(text) != std::string::npos) return true;
    if (ended) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

std::vector<int> Started::children(std::size_t count) {
  const std::string process = std::to_string(process_);
  while (!has_ended()) {
    std::istringstream list(read_file("/proc/" + process + "/task/" + process + "/children"));
    std::vector<int> children{std::istream_iterator<int>(list), {}};
    if (children.size() >= count) return children;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return {};
}

Outcome Started::wait() {
  if (!status_) {
    int status = 0;
    waitpid(process_, &status, 0);
    status_ = status;
  }
  return {WIFEXITED(*status_) ? WEXITSTATUS(*status_) : 128 + WTERMSIG(*status_),
          read_file(output_->path() / "out"), read_file(output_->path() / "err")};
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
