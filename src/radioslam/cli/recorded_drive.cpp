#include "radioslam/cli/recorded_drive.hpp"

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/lidar/kitti_sequence.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam::cli {
namespace {

constexpr std::size_t kMinPoses = 4;  ///< two for each robot

}  // namespace

RecordedDrive read_drive(const std::string& call, const std::string& trajectory,
                         const std::string& odometry) {
  if (trajectory.empty() || odometry.empty())
    throw InputError(call, 0, "needs a recorded drive: --trajectory FILE (true poses) and --odometry FILE");
  RecordedDrive drive{read_kitti_poses(read_text(trajectory)), read_kitti_poses(read_text(odometry))};
  if (drive.truth.size() != drive.odometry.size())
    throw InputError(odometry, 0,
                     "has " + std::to_string(drive.odometry.size()) + " poses, " + trajectory + " has " +
                         std::to_string(drive.truth.size()));
  if (drive.truth.size() < kMinPoses) throw InputError(trajectory, 0, "has too few poses to be cut in two");
  return drive;
}

}  // namespace radioslam::cli
