// Imports LiDAR drives in the layout of the KITTI odometry benchmark (Geiger et al. 2012) as 3D missions of
// one robot, whose body frame is that of the LiDAR:
//
//   SOURCE/velodyne/000000.bin    float32 x y z intensity; or SOURCE/bin/, or in SOURCE itself
//   SOURCE/times.txt              seconds, one line per scan; if missing, times in names or 10 Hz
//   SOURCE/calib.txt              its line Tr, Tr_velo_cam or Tr_velo_to_cam is T_camera_lidar
//   SOURCE/../../poses/NAME.txt   of the camera if calib.txt gives T_camera_lidar, otherwise of the LiDAR;
//                                 or SOURCE/poses_kitti.txt or SOURCE/poses.txt
//
// A scan's number is the number at the end of its name, if all names have the same prefix. Otherwise a name
// may end with a time (decimal seconds, 16 digits of microseconds or 17 to 19 of nanoseconds), which is used
// if there is no times.txt. Otherwise scans are ordered by name. If there are as many lines of times or poses
// as scans, they belong together in order; otherwise line k, counted from 0, belongs to scan number k.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/lidar/bin_layout.hpp"
#include "radioslam/io/mission/imported_mission.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

// Reads trajectories of the KITTI odometry benchmark (Geiger et al. 2012): twelve numbers per line, the rows
// of [R t]. There are no stamps; line k gets k / 10 s. The frames are those of the file.

inline constexpr double kKittiFrequency_hz = 10;

/// Reads the next twelve numbers of a line. Refuses a matrix that is not a rotation up to rounding.
SE3 read_kitti_matrix(LineFields& fields);

/// Refuses (InputError) a matrix that is not a rotation up to rounding, and a text without poses.
Trajectory<SE3> read_kitti_poses(const Text& text);

/// A scan file to be copied.
struct KittiScan {
  std::filesystem::path file;
  Stamp stamp;
};

struct KittiDrive {
  ImportedMission imported;  ///< without scans, whose files hold more than points
  std::vector<KittiScan> scans;
  std::size_t floats = kBinFloats;  ///< of a point (bin_layout.hpp); the first four are read
};

/// `poses` is a file with the true poses; if it is empty, the one of the layout is used. Refuses (InputError)
/// a source that is not a folder or has no scans, a scan that is not a whole number of points, times that do
/// not increase, and lists that are too short for the scans.
KittiDrive read_kitti_drive(const std::filesystem::path& source, const std::string& robot,
                            const std::filesystem::path& poses = {});

/// Copies the scans into a robot's folder lidar/ (lidar_folder.hpp): byte for byte if their points have four
/// floats, otherwise the first four of them, with 0 for what is missing.
void copy_kitti_scans(const KittiDrive& drive, const std::filesystem::path& folder);

}  // namespace radioslam
