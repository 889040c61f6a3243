// Outputs that are whole or not there: written beside their place and renamed at the end. What is unfinished
// goes when its object goes (an exception) or on remove_unfinished_outputs() (an interruption).
#pragma once

#include <filesystem>
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

/// A file that appears at once, in place of an older one.
class OutputFile : private UnfinishedOutput {
 public:
  /// Refuses (InputError) a target that is a folder or a device, and a folder that does not let us write.
  explicit OutputFile(const std::filesystem::path& target);

  void commit(std::string_view content);
};

/// Writes a file inside an output folder, with the folders it needs; std::system_error if that fails.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Removes whatever is being written, and lets nothing be moved to its place from then on. For the thread
/// that ends an interrupted program; it locks and allocates, so never call it from a signal handler.
void remove_unfinished_outputs() noexcept;

}  // namespace radioslam
