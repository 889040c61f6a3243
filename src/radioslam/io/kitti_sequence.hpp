// LiDAR drives in the layout of the KITTI odometry benchmark (Geiger et al. 2012), as missions of one robot
// in space, whose body is its LiDAR:
//
//   SOURCE/velodyne/000000.bin    float32 x y z intensity; or SOURCE/bin/, or in SOURCE itself
//   SOURCE/times.txt              seconds, a line per scan; without it as names tell, or 10 Hz
//   SOURCE/calib.txt              where a line Tr, Tr_velo_cam or Tr_velo_to_cam is T_camera_lidar
//   SOURCE/../../poses/NAME.txt   of the camera where calib.txt tells where that is, otherwise of the LiDAR;
//                                 or SOURCE/poses_kitti.txt or SOURCE/poses.txt
//
// A scan's number is what its name ends with, where all names have the same before it; otherwise a name may
// end with a time (seconds with a point, 16 digits of microseconds or 17 to 19 of nanoseconds), which counts
// where there is no times.txt; else scans are in the order of their names. Lines of times and poses are the
// scans' in turn where there are as many; otherwise line k is that of scan number k, from 0 on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/imported_mission.hpp"

namespace radioslam {

/// A scan that is to be copied as it is.
struct KittiScan {
  std::filesystem::path file;
  Stamp stamp;
};

struct KittiDrive {
  ImportedMission imported;  ///< the robot's scans stand apart, for they hold more than points
  std::vector<KittiScan> scans;
};

/// `poses` is a file of the truth in place of the layout's own; empty for that. Refuses (InputError) a source
/// that is no folder or has no scans, a scan that is not a whole number of points, times that do not run
/// forward, and lists that are too short for the scans.
KittiDrive read_kitti_drive(const std::filesystem::path& source, const std::string& robot,
                            const std::filesystem::path& poses = {});

/// Copies the scans into a robot's folder lidar/ (lidar_folder.hpp), byte for byte.
void copy_kitti_scans(const std::vector<KittiScan>& scans, const std::filesystem::path& folder);

}  // namespace radioslam
