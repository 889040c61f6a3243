// Outputs that are whole or not there: written beside their place and renamed at the end. What is unfinished
// goes when its object goes (an exception) or on remove_unfinished_outputs() (an interruption).
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace radioslam {

/// A path beside the target that is removed unless it is moved there.
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

/// Which folder a command writes, told by a file that every such folder has.
inline constexpr std::string_view kRunFolder = "summary.json";
inline constexpr std::string_view kMissionFolder = "mission.yaml";

/// A folder that appears at once, in place of an older one.
class OutputFolder : private UnfinishedOutput {
 public:
  /// Refuses (InputError) a target that is a file, a folder with something in it but no file `marker` (that
  /// is not ours to replace), and a place where no folder can be made.
  OutputFolder(const std::filesystem::path& target, std::string_view marker);

  /// Write into this folder.
  const std::filesystem::path& path() const { return temporary_; }
  /// Moves it to the target, as a whole; an older folder there is removed.
  void commit();
};

/// A file that appears at once, in place of an older one. std::system_error when it cannot be written.
class OutputFile : private UnfinishedOutput {
 public:
  /// Refuses (InputError) a target that is a folder or a device, and a folder that does not let us write.
  explicit OutputFile(const std::filesystem::path& target);

  /// Writes what is larger than the memory should hold, part by part.
  void append(std::string_view part);
  /// Moves what was appended, and then `content`, to the target.
  void commit(std::string_view content = {});

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
};

/// Writes a file inside an output folder, with the folders it needs; std::system_error if that fails.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Removes whatever is being written, and lets nothing be moved to its place from then on. For the thread
/// that ends an interrupted program; it locks and allocates, so never call it from a signal handler.
void remove_unfinished_outputs() noexcept;

}  // namespace radioslam
