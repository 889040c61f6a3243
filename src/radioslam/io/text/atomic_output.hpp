// Atomic outputs: files and folders are written next to their target and renamed on completion, so that a
// target is either complete or absent. Unfinished outputs are removed by the destructor (exceptions) or by
// remove_unfinished_outputs() (signals).
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

namespace radioslam {

/// A temporary path next to the target, removed unless it has been moved to the target.
class UnfinishedOutput {
 public:
  UnfinishedOutput(const UnfinishedOutput&) = delete;
  UnfinishedOutput& operator=(const UnfinishedOutput&) = delete;

 protected:
  explicit UnfinishedOutput(const std::filesystem::path& target);
  ~UnfinishedOutput();

  std::filesystem::path target_;
  std::filesystem::path temporary_;
};

/// Marker files by which a command recognises folders that it may replace.
inline constexpr std::string_view kRunFolder = "summary.json";
inline constexpr std::string_view kMissionFolder = "mission.yaml";

/// A folder that is written atomically and replaces an older one.
class OutputFolder : private UnfinishedOutput {
 public:
  /// Refuses (InputError) a target that is a file, a non-empty folder without a file `marker` (it was not
  /// written by this program), and a place where no folder can be created.
  OutputFolder(const std::filesystem::path& target, std::string_view marker);

  /// The folder to write into.
  const std::filesystem::path& path() const { return temporary_; }
  /// Moves the folder to the target; an older folder there is removed.
  void commit();
  /// Instead of the whole folder, moves parts of it, or out of the way into it, one after the other; what is
  /// at `to` goes to `from`. All moves are undone if one fails (std::system_error).
  struct Move {
    std::filesystem::path from, to;
  };
  void commit_parts(const std::vector<Move>& moves);
};

/// A file that is written atomically and replaces an older one. Throws std::system_error if it cannot be
/// written.
class OutputFile : private UnfinishedOutput {
 public:
  /// Refuses (InputError) a target that is a folder or a device, or that lies in a folder without write
  /// permission.
  explicit OutputFile(const std::filesystem::path& target);

  /// Appends a part of the content; for content too large to hold in memory.
  void append(std::string_view part);
  /// What was appended is in the unfinished file even if the program is killed.
  void flush();
  /// Appends `content` and moves the file to the target.
  void commit(std::string_view content = {});

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
};

/// A file inside an output folder that is written piece by piece. Creates its parent folders; throws
/// std::system_error on failure.
class FileWriter {
 public:
  explicit FileWriter(const std::filesystem::path& path);

  void write(std::string_view part);
  /// To be called after the last part: only then are all errors known.
  void close();

 private:
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// The same in one piece.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Removes all unfinished outputs and prevents any later commit. For the thread that ends an interrupted
/// program: it locks and allocates, so it must not be called from a signal handler.
void remove_unfinished_outputs() noexcept;

}  // namespace radioslam
