#include "radioslam/io/ros/ros_recording.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/ros/mcap.hpp"
#include "radioslam/io/ros/mcap_format.hpp"
#include "radioslam/io/ros/ros1_bag.hpp"
#include "radioslam/io/ros/ros_database.hpp"
#include "radioslam/io/text/compressed_text.hpp"
#include "radioslam/io/text/skipped_records.hpp"
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

constexpr double kMaxOverlap_s = 1;
constexpr std::size_t kMaxDecompressedPart = std::size_t{1} << 33U;
constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";

bool is_zstd_name(const fs::path& file) { return file.extension() == ".zstd" || file.extension() == ".zst"; }

/// The name of a part without what tells that it is compressed, or was not closed: k_0.db3 of k_0.db3.zstd.
fs::path plain_name(const fs::path& file) {
  const fs::path name = file.filename();
  return is_zstd_name(name) || name.extension() == ".active" ? name.stem() : name;
}

bool is_recording_name(const fs::path& file) {
  const std::string extension = plain_name(file).extension().string();
  return extension == ".bag" || extension == ".mcap" || extension == ".db3";
}

/// Whether the name is that of a recording with something behind it: k_0.mcap.gz.
bool looks_like_a_recording(const fs::path& file) {
  const std::string extension = file.stem().extension().string();
  return !is_recording_name(file) && (extension == ".bag" || extension == ".mcap" || extension == ".db3") &&
         file.extension() != ".db3-wal" && !is_hidden(file);
}

/// The files of a recording, and notes on what is missing of it.
struct RecordingFiles {
  std::vector<fs::path> files;
  std::vector<std::string> notes;
};

/// Of a part that is there plain and compressed, as a recorder leaves it that is killed in between, the plain
/// one.
void leave_out_twins(RecordingFiles& found) {
  std::set<fs::path> plain;
  for (const fs::path& file : found.files)
    if (!is_zstd_name(file)) plain.insert(file.filename());
  std::erase_if(found.files, [&](const fs::path& file) {
    const bool is_twin = is_zstd_name(file) && plain.contains(plain_name(file));
    if (is_twin) found.notes.push_back(file.string() + ": is left out beside the same part uncompressed");
    return is_twin;
  });
}

/// The names of the parts that metadata.yaml lists; none if it cannot be read.
std::vector<fs::path> listed_parts(const fs::path& metadata) {
  std::vector<fs::path> parts;
  if (!fs::exists(metadata)) return parts;
  try {
    const YAML::Node listed =
        YAML::LoadFile(metadata.string())["rosbag2_bagfile_information"]["relative_file_paths"];
    for (const YAML::Node& part : listed) parts.push_back(fs::path(part.as<std::string>()).filename());
  } catch (const YAML::Exception&) {  // the parts are there without it
  }
  return parts;
}

void note_absent_parts(const fs::path& folder, RecordingFiles& found) {
  std::set<fs::path> there;
  for (const fs::path& file : found.files) there.insert(plain_name(file));
  for (const fs::path& part : listed_parts(folder / "metadata.yaml"))
    if (!there.contains(plain_name(part)))
      found.notes.push_back((folder / "metadata.yaml").string() + ": names " + part.string() +
                            ", which is not there: that part of the recording is missing");
}

RecordingFiles recording_files(const fs::path& source) {
  if (!fs::exists(source)) throw InputError(source.string(), 0, "no such file or folder");
  if (!fs::is_directory(source)) return {{source}, {}};
  RecordingFiles found{files_in(source, Depth::kFolder, is_recording_name), {}};
  const std::vector<fs::path> others = files_in(source, Depth::kFolder, looks_like_a_recording);
  if (found.files.empty())
    throw InputError(source.string(), 0,
                     "contains no recording: no .bag, .mcap or .db3, as such or with .zstd or .zst" +
                         (others.empty() ? "" : "; " + others.front().filename().string() + " is not read"));
  leave_out_twins(found);
  note_absent_parts(source, found);
  for (const fs::path& other : others)
    found.notes.push_back(other.string() + ": is not read; if it is a part of the recording, decompress it");
  return found;
}

/// What a file records, to compare it with others: the times of its first and last message, and a hash of
/// each message, sorted.
struct FileSummary {
  Stamp first, last;
  std::vector<std::size_t> messages;
};

/// Nothing without a message.
std::optional<FileSummary> summary_of(const fs::path& file) {
  FileSummary summary;
  SkippedRecords noted_later;
  const auto take = [&](const RosMessage& message) {
    const bool is_first = summary.messages.empty();
    summary.first = is_first ? message.stamp : std::min(summary.first, message.stamp);
    summary.last = is_first ? message.stamp : std::max(summary.last, message.stamp);
    const std::string key = message.channel.topic + ' ' + std::to_string(message.stamp.ns) + ' ';
    summary.messages.push_back(std::hash<std::string>{}(key + std::string(message.bytes)));
  };
  noted_later.attempt([&] { return visit_recording(file, {[](const RosChannel&) { return true; }, take}); });
  std::sort(summary.messages.begin(), summary.messages.end());
  return summary.messages.empty() ? std::nullopt : std::optional(std::move(summary));
}

/// Whether two files are of recordings made at the same time, and not copies of the same messages.
bool are_simultaneous(const FileSummary& a, const FileSummary& b) {
  if (seconds_between(std::max(a.first, b.first), std::min(a.last, b.last)) <= kMaxOverlap_s) return false;
  std::vector<std::size_t> same;
  std::set_intersection(a.messages.begin(), a.messages.end(), b.messages.begin(), b.messages.end(),
                        std::back_inserter(same));
  return 2 * same.size() < std::min(a.messages.size(), b.messages.size());
}

/// The name with every number replaced by one sign.
std::string without_numbers(const fs::path& file) {
  std::string name;
  for (const char c : plain_name(file).string()) {
    const bool is_digit = c >= '0' && c <= '9';
    if (!is_digit || !name.ends_with('#')) name += is_digit ? '#' : c;
  }
  return name;
}

/// Whether files are the parts of one recording: their names differ in numbers alone, and they do not overlap
/// in time, but for copies of the same messages.
bool are_parts(const std::vector<fs::path>& files) {
  if (files.empty()) return false;
  for (const fs::path& file : files)
    if (without_numbers(file) != without_numbers(files.front())) return false;
  std::vector<FileSummary> earlier;
  for (const fs::path& file : files) {
    auto summary = summary_of(file);
    if (!summary) continue;
    for (const FileSummary& other : earlier)
      if (are_simultaneous(other, *summary)) return false;
    earlier.push_back(std::move(*summary));
  }
  return true;
}

[[noreturn]] void refuse_foreign(const std::string& name) {
  throw InputError(name, 0,
                   "at byte 0: not a recording: neither an MCAP file, nor a ROS 1 bag of version 2.0, nor a "
                   "rosbag2 database");
}

std::vector<std::string> visit_bytes(const std::string& name, std::string_view bytes,
                                     const RosVisitor& visitor) {
  if (bytes.starts_with(kMcapMagic)) return visit_mcap(name, bytes, visitor);
  if (bytes.starts_with(kRos1BagMagic)) return visit_ros1_bag(name, bytes, visitor);
  if (bytes.starts_with(kDatabaseMagic)) return visit_ros_database(name, bytes, visitor);
  refuse_foreign(name);
}

std::vector<std::string> visit_file(const fs::path& file, const RosVisitor& visitor) {
  const MappedFile mapped(file);
  const std::string name = file.string();
  if (mapped.bytes().starts_with(kDatabaseMagic)) return visit_ros_database(file, visitor);
  if (mapped.bytes().starts_with(kZstdMagic))
    return visit_bytes(name, decompress_zstd(name, mapped.bytes(), kMaxDecompressedPart), visitor);
  return visit_bytes(name, mapped.bytes(), visitor);
}

/// Passes the messages of the files on, without those of files that cannot be read; refuses if none can.
std::vector<std::string> visit_files(const RecordingFiles& parts, const RosVisitor& visitor) {
  std::vector<std::string> warnings = parts.notes;
  SkippedRecords unreadable;
  bool has_failed = false;  // the visitor, whose errors are not those of a file
  const RosVisitor watched{visitor.reads, [&](const RosMessage& message) {
                             has_failed = true;
                             visitor.take(message);
                             has_failed = false;
                           }};
  for (const fs::path& file : parts.files) try {
      const auto more = visit_file(file, watched);
      warnings.insert(warnings.end(), more.begin(), more.end());
    } catch (const InputError& error) {
      if (has_failed) throw;
      unreadable.add(error);
    }
  if (unreadable.count() == parts.files.size()) unreadable.throw_first();
  if (unreadable.count() > 0)
    warnings.push_back(unreadable.warning(parts.files.front().parent_path().string(), "file"));
  return warnings;
}

}  // namespace

std::string short_type(std::string_view type) {
  std::string result(type);
  if (const std::size_t middle = result.find("/msg/"); middle != std::string::npos) result.erase(middle, 4);
  return result;
}

std::vector<std::string> visit_recording(const fs::path& source, const RosVisitor& visitor) {
  return visit_files(recording_files(source), visitor);
}

std::vector<fs::path> recordings_in(const fs::path& source) {
  if (!fs::is_directory(source)) return {source};
  RecordingFiles found{files_in(source, Depth::kFolder, is_recording_name), {}};
  leave_out_twins(found);
  const bool is_one =
      found.files.size() == 1 || fs::exists(source / "metadata.yaml") || are_parts(found.files);
  std::set<fs::path> recordings;  // a folder stands for the files in it, without those below
  for (const fs::path& file : files_in(source, Depth::kBelow, is_recording_name))
    if (file.parent_path() != source) recordings.insert(file.parent_path());
  if (is_one && !found.files.empty())
    recordings.insert(source);
  else
    recordings.insert(found.files.begin(), found.files.end());
  if (recordings.empty()) return {source};
  return {recordings.begin(), recordings.end()};
}

std::string recording_name(const fs::path& source) {
  fs::path path = fs::absolute(source).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  if (fs::is_directory(path) || !is_recording_name(path)) return path.filename().string();
  return plain_name(path).stem().string();
}

}  // namespace radioslam
