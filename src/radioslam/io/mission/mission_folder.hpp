// Reads and writes mission folders: mission.yaml, the recordings of each robot, and the tables of the team.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/mission/team_names.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

/// What can provide an odometry.tum that is missing, for messages.
inline constexpr const char* kOdometrySources =
    "`import odometry` takes one from a table of poses, `import imu` from an accelerometer and a gyroscope, "
    "`import waypoints` from a table of t_s,x,y";

/// Reads mission.yaml, each robot's odometry.tum, wifi.csv, imu.csv and gnss.csv, radio/*.csv and
/// matches.csv, and the captures in csi/ of robots with the key `csi` in mission.yaml. Lists the scans in
/// lidar/, which are read on demand; a robot with scans needs no odometry.tum. Never reads the ground truth.
/// All errors are InputErrors; those that concern several files name mission.yaml.
Mission read_mission(const std::filesystem::path& folder);

/// A mission without its recordings.
struct MissionNames {
  Mission mission;
  std::vector<Antennas> antennas;  ///< by robot
};

/// Reads mission.yaml and radio/anchors.csv alone: what robots that are about to measure must know.
MissionNames read_mission_names(const std::filesystem::path& folder);

/// Reads robots/<id>/groundtruth.tum of the mission's robots; a robot without one has no poses. If all
/// orientations of a robot are the identity, only its positions are used. Also reads the labels of
/// measurements, if a simulator wrote them (truth_labels.hpp).
Truth read_truth(const std::filesystem::path& folder, const Mission& mission);

/// Reads a TUM file as the truth of a robot, as above.
RobotTruth read_robot_truth(const std::filesystem::path& file, const std::string& id);

/// Writes a mission's files into an existing folder (see OutputFolder). The truth may be empty. A robot
/// without odometry gets no odometry.tum, which has to be added before the mission can be read.
void write_mission(const std::filesystem::path& folder, const Mission& mission, const Truth& truth = {});

}  // namespace radioslam
