#include "radioslam/io/ros/ros_recording.hpp"

#include <algorithm>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/ros/mcap.hpp"
#include "radioslam/io/ros/ros1_bag.hpp"
#include "radioslam/io/ros/ros_database.hpp"
#include "radioslam/io/text/mapped_file.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

bool is_recording_name(const fs::path& file) {
  const std::string extension = file.extension().string();
  return extension == ".bag" || extension == ".mcap" || extension == ".db3";
}

std::vector<fs::path> recording_files(const fs::path& source) {
  if (!fs::exists(source)) throw InputError(source.string(), 0, "no such file or folder");
  if (!fs::is_directory(source)) return {source};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(source))
    if (entry.is_regular_file() && is_recording_name(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
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
