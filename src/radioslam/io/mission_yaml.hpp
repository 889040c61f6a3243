// mission.yaml: who took part, how noisy the odometry is, and where each robot started.
//
//   format: radioslam-mission/1
//   name: carpark-1                     # the folder's name when missing
//   dimension: 2                        # 2 (when missing) or 3
//   robots: {a: {...}, b: {...}}        # overrides of anything under defaults
//   defaults:
//     odometry: {sigma_xy_per_sqrt_m: 0.02, sigma_yaw_per_sqrt_m_rad: 0.002, sigma_yaw_per_rad: 0.01,
//                sigma_z_per_sqrt_m: 0.01, sigma_yaw_drift_per_m_rad: 0, sigma_scale: 0}
//     lidar: {range_m: 30, view_deg: 360}    # width of the horizontal field of view about body x
//     heading: relative                 # or absolute
//     sigma_heading_rad: 0.2            # of an absolute heading
//     initial_pose: unknown             # or [x, y, z, yaw] in the common frame
//     antennas: {front: [0.2, 0, 0.1]}  # where each sits in the body frame; gnss: that of position fixes
//     csi: {mac: "00:16:ea:00:00:01", channel: 108, antennas: [front]}    # the WiFi card (csi_yaml.hpp)
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/team_names.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// The antenna whose places a robot's gnss.csv tells; the body's origin where there is none.
inline constexpr std::string_view kFixAntenna = "gnss";

/// The file's content: a mission without recordings, and where in the file its robots stand.
struct MissionFile {
  Mission mission;
  std::vector<Antennas> antennas;  ///< per robot
  std::vector<std::size_t> robot_lines;
  std::size_t robots_line = 1;
};

/// Refuses unknown and doubled keys, values out of range, ids that cannot be a file's name.
MissionFile read_mission_yaml(const Text& text, const std::string& default_name);

/// Everything of the mission but its recordings; of the antennas those that its ranges name, those of its
/// WiFi cards and those of position fixes.
std::string format_mission_yaml(const Mission& mission);

}  // namespace radioslam
