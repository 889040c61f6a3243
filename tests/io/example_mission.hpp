// A small valid mission with every table, as files; tests change one thing in it.
#pragma once

#include <map>
#include <string>

#include "temporary_folder.hpp"

namespace radioslam {

using Files = std::map<std::string, std::string>;

inline Files example_mission() {
  return {
      {"mission.yaml",
       "format: radioslam-mission/1\n"
       "name: example\n"
       "dimension: 2\n"
       "robots:\n"
       "  a: {antennas: {front: [0.2, 0, 0.1]}}\n"
       "  b: {heading: absolute, initial_pose: [1, 2, 0, 0.5], odometry: {sigma_yaw_per_rad: 0.3}}\n"
       "defaults:\n"
       "  odometry: {sigma_xy_per_sqrt_m: 0.05, sigma_scale: 0.01}\n"
       "  lidar: {range_m: 12}\n"
       "  sigma_heading_rad: 0.1\n"
       "  initial_pose: unknown\n"},
      {"robots/a/odometry.tum",
       "# t x y z qx qy qz qw\n0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0.6 0.8\n"},
      {"robots/a/groundtruth.tum", "0.5 0 0 0 0 0 0 1\n1.5 1 0 0 0 0 0 1\n"},
      {"robots/a/wifi.csv", "t_s,bssid,frequency_mhz,rssi_dbm\n1,AA:01,2412,-60\n1,AA:02,2412,-70\n"},
      {"robots/b/odometry.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0.6 0.8\n"},
      {"robots/b/groundtruth.tum", "0 5 0 0 0 0 0.6 0.8\n"},
      {"robots/b/wifi.csv", "t_s,bssid,frequency_mhz,rssi_dbm\n0.5,aa:02,2412,-50\n"},
      {"radio/anchors.csv", "id,x_m,y_m,z_m,sigma_m\nA1,1,2,3,0.1\nA2,,,,\n"},
      {"radio/ranges.csv", "t_s,robot_i,robot_j,range_m,sigma_m\n0.5,a,b,3,0.1\n0.2,a,A1,2,0.1\n"},
      {"radio/aoa.csv",
       "t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db\n0.5,a,b,0,7,0,0.1,-3\n"},
      {"matches.csv",
       "robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw,sigma_t_m,sigma_r_rad\n"
       "a,1,b,0,1,2,0,0,0,0,1,0.1,0.01\n"},
  };
}

inline void write_files(const TemporaryFolder& folder, const Files& files) {
  for (const auto& [name, content] : files) folder.write(name, content);
}

}  // namespace radioslam
