// Runs the program under test in a process of its own.
#pragma once

#include <filesystem>
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

std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, const std::string& content);

/// Names of all files below a folder, sorted, relative to it.
std::vector<std::string> files_in(const std::filesystem::path& folder);

}  // namespace radioslam::cli
