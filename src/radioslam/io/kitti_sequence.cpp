#include "radioslam/io/kitti_sequence.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/kitti_poses.hpp"
#include "radioslam/io/lidar_folder.hpp"
#include "radioslam/io/numbers.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestScanNumber = 1'000'000'000;
constexpr const char* kDigits = "0123456789";

struct NumberedScan {
  fs::path file;
  std::uint64_t number = 0;
};

/// A list with a line per scan, and where it stands.
template <class Value>
struct ScanList {
  fs::path file;
  std::vector<Value> values;
};

/// The number that a name ends with.
std::optional<std::uint64_t> number_in_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t last_other = stem.find_last_not_of(kDigits);
  const auto number =
      parse_id(std::string_view(stem).substr(last_other == std::string::npos ? 0 : last_other + 1));
  return number && *number <= kLargestScanNumber ? number : std::nullopt;
}

std::vector<fs::path> bin_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".bin" &&
        !entry.path().filename().string().starts_with('.'))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

fs::path folder_of_scans(const fs::path& source) {
  if (!fs::exists(source)) throw InputError(source.string(), 0, "no such folder");
  if (!fs::is_directory(source))
    throw InputError(
        source.string(), 0,
        "is a file; a folder with scans (.bin) is needed, and archives have to be unpacked first");
  for (const fs::path& folder : {source / "velodyne", source / "bin", source})
    if (!bin_files(folder).empty()) return folder;
  throw InputError(
      source.string(), 0,
      "there is no scan in it: no .bin in velodyne/, in bin/ or in the folder itself; archives have "
      "to be unpacked first");
}

/// In the order of their numbers; of names without numbers, or with equal ones, in the order of the names.
std::vector<NumberedScan> number_scans(const std::vector<fs::path>& files) {
  std::vector<NumberedScan> scans;
  for (const fs::path& file : files)
    if (const auto number = number_in_name(file)) scans.push_back({file, *number});
  std::stable_sort(scans.begin(), scans.end(),
                   [](const NumberedScan& a, const NumberedScan& b) { return a.number < b.number; });
  const auto equal = std::adjacent_find(scans.begin(), scans.end(),
                                        [](const auto& a, const auto& b) { return a.number == b.number; });
  if (scans.size() == files.size() && equal == scans.end()) return scans;
  scans.clear();
  for (const fs::path& file : files) scans.push_back({file, scans.size()});
  return scans;
}

/// The first of these files that is there.
std::optional<fs::path> first_file(const std::vector<fs::path>& candidates) {
  for (const fs::path& file : candidates)
    if (fs::is_regular_file(file)) return file;
  return std::nullopt;
}

/// The value of scan k of `scans`.
template <class Value>
const Value& value_of(const ScanList<Value>& list, const std::vector<NumberedScan>& scans, std::size_t k) {
  if (list.values.size() == scans.size()) return list.values[k];
  if (scans[k].number < list.values.size()) return list.values[scans[k].number];
  throw InputError(list.file.string(), 0,
                   "has " + std::to_string(list.values.size()) + " lines for " +
                       std::to_string(scans.size()) + " scans, and none for " +
                       scans[k].file.filename().string());
}

ScanList<Stamp> read_times(const fs::path& file) {
  ScanList<Stamp> times{file, {}};
  const Text text = read_text(file);
  TextLines lines(text);
  while (lines.next_with_content()) {
    LineFields fields(lines);
    const Stamp stamp = fields.stamp("the time");
    fields.end();
    if (!times.values.empty() && stamp <= times.values.back()) lines.fail("time does not run forward");
    times.values.push_back(stamp);
  }
  return times;
}

/// T_camera_lidar, where the calibration tells it.
std::optional<SE3> read_calibration(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  const Text text = read_text(file);
  TextLines lines(text);
  while (lines.next_with_content()) {
    LineFields fields(lines);
    const std::string_view name = fields.next("a name");
    for (const char* known : {"Tr:", "Tr_velo_cam:", "Tr_velo_to_cam:"})
      if (name == known) return read_kitti_matrix(fields);
  }
  return std::nullopt;
}

/// T_start_lidar of each line of a file of poses.
ScanList<SE3> read_poses(const fs::path& file, const std::optional<SE3>& T_camera_lidar) {
  ScanList<SE3> poses{file, {}};
  const SE3 T_pose_lidar = T_camera_lidar.value_or(SE3());
  for (const auto& entry : read_kitti_poses(read_text(file)))
    poses.values.push_back(T_pose_lidar.inverse() * entry.pose * T_pose_lidar);
  return poses;
}

/// The folders in which lists may stand: that of the drive, first.
std::vector<fs::path> list_folders(const fs::path& scans) {
  const fs::path folder = fs::absolute(scans).lexically_normal();
  const std::string name = folder.filename().string();
  if (name == "velodyne" || name == "bin") return {folder.parent_path(), folder};
  return {folder};
}

std::optional<fs::path> find_poses(const std::vector<fs::path>& folders) {
  std::vector<fs::path> candidates;
  for (const fs::path& folder : folders)
    for (const char* name : {"poses_kitti.txt", "poses.txt"}) candidates.push_back(folder / name);
  const fs::path& drive = folders.front();
  candidates.push_back(drive.parent_path().parent_path() / "poses" / (drive.filename().string() + ".txt"));
  return first_file(candidates);
}

std::vector<KittiScan> stamp_scans(const std::vector<NumberedScan>& numbered,
                                   const std::optional<ScanList<Stamp>>& times) {
  std::vector<KittiScan> scans;
  for (std::size_t k = 0; k < numbered.size(); ++k)
    scans.push_back({numbered[k].file, times ? value_of(*times, numbered, k)
                                             : Stamp::from_seconds(static_cast<double>(numbered[k].number) /
                                                                   kKittiFrequency_hz)});
  return scans;
}

Trajectory<SE3> truth_of(const ScanList<SE3>& poses, const std::vector<NumberedScan>& numbered,
                         const std::vector<KittiScan>& scans) {
  std::vector<StampedPose<SE3>> truth;
  for (std::size_t k = 0; k < scans.size(); ++k)
    truth.push_back({scans[k].stamp, value_of(poses, numbered, k)});
  return Trajectory<SE3>(std::move(truth));
}

}  // namespace

KittiDrive read_kitti_drive(const fs::path& source, const std::string& robot, const fs::path& poses) {
  const fs::path folder = folder_of_scans(source.has_filename() ? source : source.parent_path());
  const std::vector<fs::path> folders = list_folders(folder);
  const std::vector<NumberedScan> numbered = number_scans(bin_files(folder));
  for (const NumberedScan& scan : numbered) check_bin_size(scan.file, fs::file_size(scan.file));
  std::optional<ScanList<Stamp>> times;
  for (const fs::path& place : folders)
    if (!times && fs::exists(place / "times.txt")) times = read_times(place / "times.txt");
  KittiDrive drive;
  drive.scans = stamp_scans(numbered, times);
  drive.imported.mission.dimension = 3;
  drive.imported.mission.robots.emplace_back().id = robot;
  if (!times)
    drive.imported.warnings.emplace_back("there is no times.txt; the scans are taken to be at 10 Hz");
  const auto truth_file = poses.empty() ? find_poses(folders) : poses;
  if (!truth_file) return drive;
  const auto T_camera_lidar = read_calibration(folders.front() / "calib.txt");
  const auto truth = truth_of(read_poses(*truth_file, T_camera_lidar), numbered, drive.scans);
  drive.imported.truth.robots.push_back({robot, truth, true});
  drive.imported.warnings.push_back("the truth is " + truth_file->string() + ", of the " +
                                    (T_camera_lidar ? "camera" : "LiDAR"));
  return drive;
}

void copy_kitti_scans(const std::vector<KittiScan>& scans, const fs::path& folder) {
  fs::create_directories(folder);
  for (const KittiScan& scan : scans)
    fs::copy_file(scan.file, folder / (std::to_string(scan.stamp.ns) + ".bin"));
}

}  // namespace radioslam
