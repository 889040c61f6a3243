// Reads and writes mission.yaml: the robots, their odometry noise, sensors and starts.
//
//   format: radioslam-mission/1
//   name: carpark-1                     # default: the folder's name
//   dimension: 2                        # 2 (default) or 3
//   robots: {a: {...}, b: {...}}        # overrides of anything under defaults
//   defaults:
//     odometry: {sigma_xy_per_sqrt_m: 0.02, sigma_yaw_per_sqrt_m_rad: 0.002, sigma_yaw_per_rad: 0.01,
//                sigma_z_per_sqrt_m: 0.01, sigma_yaw_drift_per_m_rad: 0, sigma_scale: 0}
//     lidar: {range_m: 30, view_deg: 360}    # width of the horizontal field of view about body x
//     heading: relative                 # or absolute
//     sigma_heading_rad: 0.2            # standard deviation of an absolute heading
//     initial_pose: unknown             # or [x, y, z, yaw] in the common frame
//     antennas: {front: [0.2, 0, 0.1]}  # lever arms in the body frame; gnss: that of position fixes
//     csi: {mac: "00:16:ea:00:00:01", channel: 108, antennas: [front]}    # WiFi card (csi_yaml.hpp)
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/io/mission/team_names.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

// Keys of the odometry noise in mission.yaml.

inline constexpr std::array<std::pair<std::string_view, double OdometryNoise::*>, 6> kOdometryNoiseFields = {
    {{"sigma_xy_per_sqrt_m", &OdometryNoise::sigma_xy_per_sqrt_m},
     {"sigma_yaw_per_sqrt_m_rad", &OdometryNoise::sigma_yaw_per_sqrt_m_rad},
     {"sigma_yaw_per_rad", &OdometryNoise::sigma_yaw_per_rad},
     {"sigma_z_per_sqrt_m", &OdometryNoise::sigma_z_per_sqrt_m},
     {"sigma_yaw_drift_per_m_rad", &OdometryNoise::sigma_yaw_drift_per_m_rad},
     {"sigma_scale", &OdometryNoise::sigma_scale}}};

/// Name of the antenna whose positions are in a robot's gnss.csv; without it, they are those of the body's
/// origin.
inline constexpr std::string_view kFixAntenna = "gnss";

/// The content of the file: a mission without recordings, and the lines of its robots.
struct MissionFile {
  Mission mission;
  std::vector<Antennas> antennas;  ///< per robot
  std::vector<std::size_t> robot_lines;
  std::size_t robots_line = 1;
};

/// Refuses (InputError) unknown and repeated keys, values out of range, and ids that are not valid file
/// names.
MissionFile read_mission_yaml(const Text& text, const std::string& default_name);

/// The mission without its recordings. Of the antennas, those that are named by ranges or belong to WiFi
/// cards or position fixes are written.
std::string format_mission_yaml(const Mission& mission);

/// A mission.yaml with the robots of `added`, appended to its robots unless they are there; everything else
/// in it stays as it is written, comments included. A robot gets those settings that differ from this
/// program's defaults and that its entry does not state; what is kept instead goes to `notes`. Refuses
/// (InputError) a text in which no robot can be added, with its line.
std::string extended_mission_yaml(const Text& yaml, const Mission& added, std::vector<std::string>& notes);

}  // namespace radioslam
