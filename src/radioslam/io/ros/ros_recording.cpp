#include "radioslam/io/ros/ros_recording.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/ros/mcap.hpp"
#include "radioslam/io/ros/ros1_bag.hpp"
#include "radioslam/io/ros/ros_database.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

/// Memory-mapped input file, for files that may be larger than the memory.
class MappedFile {
 public:
  /// Refuses (InputError) a path that is missing, is a folder or cannot be read. The file must not shrink
  /// while mapped.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }

 private:
  std::string_view bytes_;
};

/// RAII wrapper of a file descriptor.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

[[noreturn]] void fail_with_errno(const std::filesystem::path& path, const char* what) {
  throw InputError(path.string(), 0, std::string(what) + ": " + std::strerror(errno));
}

MappedFile::MappedFile(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw InputError(path.string(), 0, "no such file");
  if (!std::filesystem::is_regular_file(path)) throw InputError(path.string(), 0, "is not a file");
  const OpenFile file(path);
  if (file.descriptor() < 0) fail_with_errno(path, "cannot be opened");
  struct stat status {};
  if (::fstat(file.descriptor(), &status) != 0) fail_with_errno(path, "cannot be read");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return;
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.descriptor(), 0);
  if (data == MAP_FAILED) fail_with_errno(path, "cannot be read");
  bytes_ = {static_cast<const char*>(data), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

namespace fs = std::filesystem;

bool is_recording_name(const fs::path& file) {
  const std::string extension = file.extension().string();
  return extension == ".bag" || extension == ".mcap" || extension == ".db3";
}

std::vector<fs::path> recording_files(const fs::path& source) {
  if (!fs::exists(source)) throw InputError(source.string(), 0, "no such file or folder");
  if (!fs::is_directory(source)) return {source};
  std::vector<fs::path> files = files_in(source, Depth::kFolder, is_recording_name);
  if (files.empty())
    throw InputError(source.string(), 0,
                     "contains no recording: no .bag, .mcap or .db3 (files that end in .zstd have to be "
                     "decompressed first)");
  return files;
}

std::vector<std::string> visit_file(const fs::path& file, const RosVisitor& visitor) {
  const MappedFile mapped(file);
  const std::string name = file.string();
  if (mapped.bytes().starts_with(kMcapMagic)) return visit_mcap(name, mapped.bytes(), visitor);
  if (mapped.bytes().starts_with(kRos1BagMagic)) return visit_ros1_bag(name, mapped.bytes(), visitor);
  if (mapped.bytes().starts_with(kDatabaseMagic)) return visit_ros_database(file, visitor);
  throw InputError(name, 0,
                   "at byte 0: not a recording: neither an MCAP file, nor a ROS 1 bag of version 2.0, nor a "
                   "rosbag2 database");
}

}  // namespace

std::string short_type(std::string_view type) {
  std::string result(type);
  if (const std::size_t middle = result.find("/msg/"); middle != std::string::npos) result.erase(middle, 4);
  return result;
}

std::vector<std::string> visit_recording(const fs::path& source, const RosVisitor& visitor) {
  std::vector<std::string> warnings;
  for (const fs::path& file : recording_files(source)) {
    const auto more = visit_file(file, visitor);
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  return warnings;
}

}  // namespace radioslam
