#include "radioslam/io/lidar/lidar_folder.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/lidar/bin_layout.hpp"
#include "radioslam/io/lidar/pcd.hpp"
#include "radioslam/io/lidar/point_table.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBinPointBytes = kBinFloats * sizeof(float);

struct ScanFile {
  fs::path path;
  Stamp stamp;
};

Stamp stamp_in_name(const fs::path& file) {
  const auto ns = parse_integer(file.stem().string());
  if (!ns)
    throw InputError(file.string(), 0, "a scan must be named by its time in whole nanoseconds",
                     InputError::Kind::kUnit);
  return {*ns};
}

/// Order by stamp, then by name.
std::vector<ScanFile> list_scans(const fs::path& folder) {
  const std::vector<fs::path> paths = files_in(folder, Depth::kFolder, [](const fs::path& file) {
    return !is_hidden(file) && (file.extension() == ".bin" || file.extension() == ".pcd");
  });
  std::vector<ScanFile> scans;
  for (const fs::path& path : paths) {
    scans.push_back({path, stamp_in_name(path)});
    if (path.extension() == ".bin") check_bin_size(path, fs::file_size(path));
  }
  std::stable_sort(scans.begin(), scans.end(),
                   [](const ScanFile& a, const ScanFile& b) { return a.stamp < b.stamp; });
  return scans;
}

LidarScan read_bin(const fs::path& file) {
  const std::string bytes = read_bytes(file);
  check_bin_size(file, bytes.size());
  if (const std::size_t floats = floats_per_point(bytes); floats != kBinFloats)
    throw InputError(file.string(), 0,
                     "is not a scan of x y z intensity: its points have " + std::to_string(floats) +
                         " floats (`radioslam import kitti` converts such scans)",
                     InputError::Kind::kColumnOrder);
  const ByteView view(bytes, ByteOrder::kLittle);
  LidarScan scan;
  const std::size_t points = bytes.size() / kBinPointBytes;
  scan.points.reserve(points);
  scan.intensities.reserve(points);
  for (std::size_t at = 0; at < bytes.size(); at += kBinPointBytes) {
    scan.points.emplace_back(view.f32(at), view.f32(at + 4), view.f32(at + 8));
    scan.intensities.push_back(view.f32(at + 12));
  }
  forget_constant_intensities(scan);
  return scan;
}

std::string format_bin(const LidarScan& scan) {
  std::string out;
  out.reserve(scan.points.size() * kBinPointBytes);
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    for (const float coordinate : scan.points[k]) append_f32(out, coordinate);
    append_f32(out, scan.intensities.empty() ? 0 : scan.intensities[k]);
  }
  return out;
}

}  // namespace

void check_bin_size(const fs::path& file, std::uintmax_t bytes) {
  if (bytes % kBinPointBytes != 0)
    throw InputError(file.string(), 0,
                     "is not a scan: its " + std::to_string(bytes) +
                         " bytes are not a multiple of a point's 16 (float32 x y z intensity)");
}

LidarLog read_lidar_folder(const fs::path& folder) {
  LidarLog log;
  if (!fs::exists(folder)) return log;
  if (!fs::is_directory(folder)) throw InputError(folder.string(), 0, "is a file, not a folder of scans");
  const auto files = std::make_shared<const std::vector<ScanFile>>(list_scans(folder));
  for (const ScanFile& file : *files) {
    if (!log.stamps.empty() && file.stamp == log.stamps.back())
      throw InputError(file.path.string(), 0, "another scan has the same time");
    log.stamps.push_back(file.stamp);
  }
  log.read = [files](std::size_t k) { return read_lidar_file(files->at(k).path, files->at(k).stamp); };
  return log;
}

LidarScan read_lidar_file(const fs::path& file, Stamp stamp) {
  if (file.extension() == ".bin") return read_bin(file);
  return read_pcd({file.string(), read_bytes(file)}, stamp);
}

void write_lidar_folder(const fs::path& folder, const LidarLog& log) {
  for (std::size_t k = 0; k < log.size(); ++k) write_lidar_scan(folder, log.stamps[k], log.read(k));
}

void write_lidar_scan(const fs::path& folder, Stamp stamp, const LidarScan& scan) {
  const std::string name = std::to_string(stamp.ns);
  if (scan.times_s.empty())
    write_file(folder / (name + ".bin"), format_bin(scan));
  else
    write_file(folder / (name + ".pcd"), format_pcd(scan));
}

}  // namespace radioslam
