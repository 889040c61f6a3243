// Reads tables from which a walker's odometry can be made: samples of an accelerometer and a gyroscope, and
// waypoints. Tables are CSV, also with semicolons (and then decimal commas) or tabs between the fields, with
// a header; read with the policy of importers (skipped_records.hpp).
//
// Columns are recognised by the names that phones' apps and ROS give them: a time (t_s, time, timestamp,
// seconds, ...), x y z of an accelerometer (ax, acc_x, linear_acceleration.x, ...) and of a gyroscope (wx,
// gx, gyro_x, angular_velocity.x, ...), or plain x y z in a file whose name has "acc" or "gyr". A file whose
// name has "gravity" is added to an accelerometer's without it, as apps for phones divide the two. Units are
// found by what is possible: times in s, ms, us or ns by their median interval, which is 0.5 to 400 ms;
// accelerations, whose mean is gravity, in m/s^2, g or thousandths of g; rates in degrees/s if their column
// says so or their RMS exceeds 6 rad/s, which nobody walks. What is not the plain unit is said in a warning.
#pragma once

#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/phone_motion.hpp"

namespace radioslam {

/// Whether the text's header has the columns of such a table.
bool is_walker_table(const Text& table);

/// The samples of all tables, in the order of time, turned by one constant rotation so that their mean force
/// points along z: the device may be carried in any attitude. Refuses (InputError) a table without a time or
/// without a sensor, tables without both sensors or with one twice, accelerations whose mean is not gravity,
/// and times of another spacing.
PhoneMotion read_walker_imu(const std::vector<Text>& tables, std::vector<std::string>& warnings);

/// Poses along the straight lines between the waypoints (columns t_s or time, x or x_m, y or y_m; in s and m)
/// at constant speed, at least one a second; yaw is the direction of the line, and at a waypoint that of the
/// line that begins there. In the frame of the table. Refuses fewer than two waypoints.
Trajectory<SE3> read_waypoints(const Text& table, std::vector<std::string>& warnings);

}  // namespace radioslam
