// Imports logs of the CARMEN toolkit (one message per line) as missions of one planar robot:
//
//   FLASER n r_1 .. r_n  x y theta  odom_x odom_y odom_theta  ipc_timestamp host logger_timestamp
//   RLASER                                                        the same for a scanner facing backwards
//   ROBOTLASER1 type start_angle field_of_view angular_resolution maximum_range accuracy remission_mode
//               n r_1 .. r_n  m i_1 .. i_m  laser_x laser_y laser_theta  robot_x robot_y robot_theta
//               tv rv forward_safety side_safety [turn_axis]  ipc_timestamp host logger_timestamp
//   PARAM robot_frontlaser_offset 0.1                             of FLASER along the body's x
//   PARAM robot_rearlaser_offset -0.1                             of RLASER along the body's x
//
// Scans are taken from the first of FLASER, ROBOTLASER1, RLASER that occurs in the log. FLASER and RLASER
// lines do not state their angles: n readings cover the field of view from its right edge, the last one at
// the left edge if n is odd (181, 361) and one step before it if n is even (180, 360). The step is thus 1
// degree for both 180 and 181: walls in the logs `aces` and `intel` then form angles of 89.9 and 90.2
// degrees, otherwise 90.3 and 90.5.
//
// Odometry is taken from the scan lines, one sample per scan, relative to the first one of the log. ODOM
// lines are ignored: they add nothing to the scans' poses, and their times jump as those of the scans do.
//
// Times are the ipc_timestamps, unchanged where they increase. A line can be stamped late if its message was
// delayed, but not early; a line stamped later than a following line is therefore moved to just before that
// one. Readings that are not positive, or not below the scanner's limit, are missing returns and are left
// out; the limit is the line's maximum_range, or else the log's largest reading.
#pragma once

#include <string>

#include "radioslam/base/fields.hpp"
#include "radioslam/io/mission/imported_mission.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

struct CarmenParams {
  double field_of_view_deg = 180;
  double no_return_m = 80;
  double max_delay_s = 10;
  double sigma_xy_per_sqrt_m = 0.05;
  double sigma_yaw_per_sqrt_m_rad = 0.02;
  double sigma_yaw_per_rad = 0.06;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(field_of_view_deg, "deg", 1, 360,
                    "field of view of scanners whose lines do not state it");
    RADIOSLAM_FIELD(no_return_m, "m", 0.1, 1e6,
                    "readings from this range on are missing returns (scanners report 81.83 m)");
    RADIOSLAM_FIELD(
        max_delay_s, "s", 0, 1e9,
        "largest delay of a line's time stamp; a log in which more than a tenth are longer is refused");
    RADIOSLAM_FIELD(sigma_xy_per_sqrt_m, "m/sqrt(m)", 0, 10,
                    "wheel odometry noise in x and y per square root of distance, for mission.yaml");
    RADIOSLAM_FIELD(
        sigma_yaw_per_sqrt_m_rad, "rad/sqrt(m)", 0, 10,
        "wheel odometry noise in yaw per square root of distance; measured on 325 m of the log `aces`");
    RADIOSLAM_FIELD(sigma_yaw_per_rad, "rad/sqrt(rad)", 0, 10,
                    "wheel odometry noise in yaw per square root of rotation, for mission.yaml");
  }
};

/// Leaves out incomplete lines, malformed numbers, and lines stamped further off than max_delay_s, with a
/// warning. Refuses (InputError) a log without scans, one of which most lines are malformed, and one of which
/// more than a tenth are stamped further off. Other lines are skipped.
ImportedMission read_carmen(const Text& text, const std::string& robot, const CarmenParams& params = {});

}  // namespace radioslam
