#include "radioslam/io/lidar/kitti_sequence.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/io/lidar/lidar_folder.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr double kRotationTolerance = 1e-2;  ///< bound on |R^T R - I|; published files reach 1e-5

namespace fs = std::filesystem;

constexpr std::size_t kScansToFindLayout = 5, kMinLayoutBytes = 2800;
constexpr std::uint64_t kMaxScanNumber = 1'000'000'000;
constexpr std::size_t kEpochDigits = 9;         ///< digits of Unix seconds, from 1973 on
constexpr std::size_t kMicrosecondDigits = 16;  ///< digits of Unix microseconds, from 2001 on
constexpr std::int64_t kMaxMicroseconds =
    std::numeric_limits<std::int64_t>::max() / kNanosecondsPerMicrosecond;
constexpr const char* kDigits = "0123456789";

/// A scan file, with the number or time in its name.
struct NamedScan {
  fs::path file;
  std::optional<std::uint64_t> number;
  std::optional<Stamp> time;
};

/// A list with one line per scan, and its file.
template <class Value>
struct ScanList {
  fs::path file;
  std::vector<Value> values;
};

/// The digits at the end: "000123" of "x_000123".
std::string digits_at_end(const std::string& name) {
  const std::size_t last_other = name.find_last_not_of(kDigits);
  return name.substr(last_other == std::string::npos ? 0 : last_other + 1);
}

/// The text before them: "x_" of "x_000123".
std::string before_digits(const std::string& name) {
  return name.substr(0, name.size() - digits_at_end(name).size());
}

/// The digits before the point: "1630577758" of "x_1630577758.569490".
std::string digits_before_point(const std::string& name) {
  const std::string before = before_digits(name);
  return before.ends_with('.') ? digits_at_end(before.substr(0, before.size() - 1)) : "";
}

/// The number at the end of a name.
std::optional<std::uint64_t> number_in_name(const std::string& name) {
  const auto number = parse_id(digits_at_end(name));
  return number && *number <= kMaxScanNumber ? number : std::nullopt;
}

/// Sixteen digits are microseconds, 17 to 19 nanoseconds; neither begins with a zero.
std::optional<Stamp> whole_time_of(const std::string& digits) {
  const auto value = parse_integer(digits);
  if (!value || digits.front() == '0' || digits.size() < kMicrosecondDigits) return std::nullopt;
  if (digits.size() > kMicrosecondDigits) return Stamp{*value};
  return *value > kMaxMicroseconds ? std::nullopt : std::optional(Stamp{*value * kNanosecondsPerMicrosecond});
}

/// The time at the end of a name: decimal seconds, or digits only.
std::optional<Stamp> time_in_scan_name(const std::string& name) {
  const std::string digits = digits_at_end(name);
  const std::string seconds = digits_before_point(name);
  if (digits.empty()) return std::nullopt;
  return seconds.empty() ? whole_time_of(digits) : parse_stamp(seconds + '.' + digits);
}

std::vector<fs::path> bin_files(const fs::path& folder) {
  if (!fs::is_directory(folder)) return {};
  return files_in(folder, Depth::kFolder,
                  [](const fs::path& file) { return file.extension() == ".bin" && !is_hidden(file); });
}

fs::path folder_of_scans(const fs::path& source) {
  if (!fs::exists(source)) throw InputError(source.string(), 0, "no such folder");
  if (!fs::is_directory(source))
    throw InputError(source.string(), 0,
                     "is a file, not a folder with scans (.bin); archives have to be unpacked first");
  for (const fs::path& folder : {source / "velodyne", source / "bin", source})
    if (!bin_files(folder).empty()) return folder;
  throw InputError(
      source.string(), 0,
      "contains no scans: no .bin in velodyne/, in bin/ or in the folder itself; archives have to be "
      "unpacked first");
}

/// Floats of a point, if the first scans of a hundred points or more agree.
std::size_t floats_of(const std::vector<NamedScan>& scans) {
  const std::size_t some = std::min(scans.size(), kScansToFindLayout);
  std::size_t floats = 0;
  for (std::size_t k = 0; k < some; ++k) {
    const std::string bytes = read_bytes(scans[k].file);
    if (bytes.size() < kMinLayoutBytes) continue;
    const std::size_t found = floats_per_point(bytes);
    if (floats != 0 && found != floats) return kBinFloats;
    floats = found;
  }
  return floats == 0 ? kBinFloats : floats;
}

/// Refuses sizes that are no multiple of a point's.
void check_sizes(const std::vector<NamedScan>& scans, std::size_t floats) {
  for (const NamedScan& scan : scans) {
    const std::uintmax_t bytes = fs::file_size(scan.file);
    if (floats == kBinFloats) check_bin_size(scan.file, bytes);
    if (bytes % (floats * sizeof(float)) != 0)
      throw InputError(scan.file.string(), 0,
                       "is not a scan: its " + std::to_string(bytes) +
                           " bytes are not a multiple of a point's " +
                           std::to_string(floats * sizeof(float)) + ", as the other scans have them");
  }
}

/// The first four floats of every point.
std::string first_four(const std::string& bytes, std::size_t floats) {
  const std::size_t kept = std::min(floats, kBinFloats) * sizeof(float);
  std::string points;
  points.reserve(bytes.size() / floats * kBinFloats);
  for (std::size_t at = 0; at < bytes.size(); at += floats * sizeof(float)) {
    points.append(bytes, at, kept);
    points.append(kBinFloats * sizeof(float) - kept, '\0');
  }
  return points;
}

template <class Key>
bool sort_by(std::vector<NamedScan>& scans, Key key) {
  std::stable_sort(scans.begin(), scans.end(),
                   [&](const NamedScan& a, const NamedScan& b) { return key(a) < key(b); });
  return std::adjacent_find(scans.begin(), scans.end(),
                            [&](const auto& a, const auto& b) { return key(a) == key(b); }) == scans.end();
}

/// Sorts scans by the times in their names, if all names have different ones.
std::vector<NamedScan> scans_by_time(const std::vector<fs::path>& files) {
  std::vector<NamedScan> scans;
  for (const fs::path& file : files)
    if (const auto time = time_in_scan_name(file.stem().string()))
      scans.push_back({file, std::nullopt, time});
  const bool are_all = scans.size() == files.size();
  return are_all && sort_by(scans, [](const NamedScan& scan) { return *scan.time; })
             ? scans
             : std::vector<NamedScan>{};
}

/// Sorts scans by the numbers in their names, if all names have different ones after the same prefix.
std::vector<NamedScan> scans_by_number(const std::vector<fs::path>& files) {
  const std::string before = before_digits(files.front().stem().string());
  std::vector<NamedScan> scans;
  for (const fs::path& file : files) {
    const std::string name = file.stem().string();
    const auto number = number_in_name(name);
    if (number && before_digits(name) == before) scans.push_back({file, number, std::nullopt});
  }
  const bool are_all = scans.size() == files.size();
  return are_all && sort_by(scans, [](const NamedScan& scan) { return *scan.number; })
             ? scans
             : std::vector<NamedScan>{};
}

/// Sorts scans by their names. Digits after a point are a number, not a fraction of a second, if all names
/// have the same prefix and that is too short for a time.
std::vector<NamedScan> order_scans(const std::vector<fs::path>& files) {
  const bool has_time = digits_before_point(files.front().stem().string()).size() >= kEpochDigits;
  if (auto scans = has_time ? std::vector<NamedScan>{} : scans_by_number(files); !scans.empty()) return scans;
  if (auto scans = scans_by_time(files); !scans.empty()) return scans;
  std::vector<NamedScan> scans;
  for (const fs::path& file : files) scans.push_back({file, std::nullopt, std::nullopt});
  return scans;
}

/// The first of these files that exists.
std::optional<fs::path> first_file(const std::vector<fs::path>& candidates) {
  for (const fs::path& file : candidates)
    if (fs::is_regular_file(file)) return file;
  return std::nullopt;
}

/// The list's value for scan k of `scans`.
template <class Value>
const Value& value_of(const ScanList<Value>& list, const std::vector<NamedScan>& scans, std::size_t k) {
  if (list.values.size() == scans.size()) return list.values[k];
  if (scans[k].number && *scans[k].number < list.values.size()) return list.values[*scans[k].number];
  throw InputError(list.file.string(), 0,
                   "has " + std::to_string(list.values.size()) + " lines for " +
                       std::to_string(scans.size()) + " scans, but none for " +
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
    if (!times.values.empty() && stamp <= times.values.back()) lines.fail("the time does not increase");
    times.values.push_back(stamp);
  }
  return times;
}

/// T_camera_lidar, if the calibration file has it.
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

/// T_start_lidar for each line of a file of poses.
ScanList<SE3> read_poses(const fs::path& file, const std::optional<SE3>& T_camera_lidar) {
  ScanList<SE3> poses{file, {}};
  const SE3 T_pose_lidar = T_camera_lidar.value_or(SE3());
  for (const auto& entry : read_kitti_poses(read_text(file)))
    poses.values.push_back(T_pose_lidar.inverse() * entry.pose * T_pose_lidar);
  return poses;
}

/// The folders that may contain lists, that of the drive first.
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

/// The time of scan k: from times.txt, its name or its number.
Stamp stamp_of_scan(const std::vector<NamedScan>& scans, const std::optional<ScanList<Stamp>>& times,
                    std::size_t k) {
  if (times) return value_of(*times, scans, k);
  if (scans[k].time) return *scans[k].time;
  return Stamp::from_seconds(static_cast<double>(scans[k].number.value_or(k)) / kKittiFrequency_hz);
}

std::vector<KittiScan> stamp_scans(const std::vector<NamedScan>& named,
                                   const std::optional<ScanList<Stamp>>& times) {
  std::vector<KittiScan> scans;
  for (std::size_t k = 0; k < named.size(); ++k)
    scans.push_back({named[k].file, stamp_of_scan(named, times, k)});
  return scans;
}

Trajectory<SE3> truth_of(const ScanList<SE3>& poses, const std::vector<NamedScan>& named,
                         const std::vector<KittiScan>& scans) {
  std::vector<StampedPose<SE3>> truth;
  for (std::size_t k = 0; k < scans.size(); ++k) truth.push_back({scans[k].stamp, value_of(poses, named, k)});
  return Trajectory<SE3>(std::move(truth));
}

}  // namespace

SE3 read_kitti_matrix(LineFields& fields) {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation(row, column) = fields.number("a rotation's entry");
    translation(row) = fields.coordinate("a translation's entry");
  }
  const double defect = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm();
  if (!(defect < kRotationTolerance) || rotation.determinant() < 0)
    fields.fail("the first three columns are not a rotation matrix");
  return {translation, Eigen::Quaterniond(rotation)};
}

Trajectory<SE3> read_kitti_poses(const Text& text) {
  std::vector<StampedPose<SE3>> poses;
  TextLines lines(text);
  while (lines.next_with_content()) {
    const double seconds = static_cast<double>(poses.size()) / kKittiFrequency_hz;
    LineFields fields(lines);
    poses.push_back({Stamp::from_seconds(seconds), read_kitti_matrix(fields)});
    fields.end();
  }
  if (poses.empty()) text.fail(1, "the file has no poses");
  return Trajectory<SE3>(std::move(poses));
}

KittiDrive read_kitti_drive(const fs::path& source, const std::string& robot, const fs::path& poses) {
  const fs::path folder = folder_of_scans(source.has_filename() ? source : source.parent_path());
  const std::vector<fs::path> folders = list_folders(folder);
  const std::vector<NamedScan> named = order_scans(bin_files(folder));
  KittiDrive drive;
  drive.floats = floats_of(named);
  check_sizes(named, drive.floats);
  std::optional<ScanList<Stamp>> times;
  for (const fs::path& place : folders)
    if (!times && fs::exists(place / "times.txt")) times = read_times(place / "times.txt");
  if (drive.floats != kBinFloats)
    drive.imported.warnings.push_back("the scans' points have " + std::to_string(drive.floats) +
                                      " floats each; the first three are taken as x, y and z");
  drive.scans = stamp_scans(named, times);
  drive.imported.mission.dimension = 3;
  drive.imported.mission.robots.emplace_back().id = robot;
  if (!times)
    drive.imported.warnings.emplace_back(named.front().time
                                             ? "there is no times.txt; the times in the scans' names are used"
                                             : "there is no times.txt; a rate of 10 Hz is assumed");
  const auto truth_file = poses.empty() ? find_poses(folders) : poses;
  if (!truth_file) return drive;
  const auto T_camera_lidar = read_calibration(folders.front() / "calib.txt");
  const auto truth = truth_of(read_poses(*truth_file, T_camera_lidar), named, drive.scans);
  drive.imported.truth.robots.push_back({robot, truth, true});
  drive.imported.warnings.push_back("the ground truth is " + truth_file->string() + ", with poses of the " +
                                    (T_camera_lidar ? "camera" : "LiDAR"));
  return drive;
}

void copy_kitti_scans(const KittiDrive& drive, const fs::path& folder) {
  fs::create_directories(folder);
  for (const KittiScan& scan : drive.scans) {
    const fs::path copy = folder / (std::to_string(scan.stamp.ns) + ".bin");
    if (drive.floats == kBinFloats)
      fs::copy_file(scan.file, copy);
    else
      write_file(copy, first_four(read_bytes(scan.file), drive.floats));
  }
}

}  // namespace radioslam
