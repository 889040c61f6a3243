// Runs the program under test in a process of its own.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace radioslam::cli {

/// Exit status and outputs of a process.
struct Outcome {
  int status = 0;  ///< exit status; 128 + signal if a signal ended it
  std::string out;
  std::string err;
};

/// A signal to send after a delay.
struct Interruption {
  int signal = 0;
  double after_s = 0;
};

/// Runs the program with the arguments, in `folder`.
Outcome run(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
            std::optional<Interruption> interruption = std::nullopt);

/// A temporary folder that is removed with this object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A program that runs beside the test; it does not outlive it.
class Started {
 public:
  Started(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  ~Started();
  Started(const Started&) = delete;
  Started& operator=(const Started&) = delete;

  void signal(int number) const;
  /// Waits until the program has written this to its standard output; false if it ends before.
  bool says(const std::string& text);
  /// The processes of its children, once there are so many; none if the program ends before.
  std::vector<int> children(std::size_t count);
  Outcome wait();

 private:
  bool has_ended();

  std::unique_ptr<TemporaryFolder> output_;
  int process_ = 0;
  std::optional<int> status_;
};

std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, const std::string& content);

/// Names of all files below a folder, sorted, relative to it.
std::vector<std::string> files_in(const std::filesystem::path& folder);

}  // namespace radioslam::cli
