// Logs of the CARMEN toolkit, one message per line, as missions of one robot in the plane:
//
//   FLASER n r_1 .. r_n  x y theta  odom_x odom_y odom_theta  ipc_timestamp host logger_timestamp
//   RLASER                                                        the same of a scanner that looks backwards
//   ROBOTLASER1 type start_angle field_of_view angular_resolution maximum_range accuracy remission_mode
//               n r_1 .. r_n  m i_1 .. i_m  laser_x laser_y laser_theta  robot_x robot_y robot_theta
//               tv rv forward_safety side_safety [turn_axis]  ipc_timestamp host logger_timestamp
//   PARAM robot_frontlaser_offset 0.1                 of FLASER, along the body's x; robot_rearlaser_offset
//
// Scans are of the first of FLASER, ROBOTLASER1, RLASER that the log has. A FLASER or RLASER line does not
// tell its angles: n readings cover the field of view from its right edge on, the last one on its left edge
// where n is odd (181, 361) and one step before it where n is even (180, 360). So the step is 1 degree for
// both 180 and 181: walls of the logs `aces` and `intel` then meet at 89.9 and 90.2 degrees, otherwise at
// 90.3 and 90.5.
//
// Odometry is what the scans' own lines say, one row per scan, from the log's first one on. ODOM lines lie
// between and hold nothing that a scan's pose does not, and their times jump where the scans' do.
//
// Times are the ipc_timestamps, exactly, where they run forward. A line can be stamped late, when its
// message was held up, but not early; so one that is stamped later than a line that follows is taken to be
// just before that one. Readings that are not positive, or not below the scanner's limit, returned nothing
// and are left out; the limit is the line's maximum_range, or the log's largest reading.
#pragma once

#include <string>

#include "radioslam/base/fields.hpp"
#include "radioslam/io/imported_mission.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

struct CarmenParams {
  double field_of_view_deg = 180;
  double no_return_m = 80;
  double largest_delay_s = 10;
  double sigma_xy_per_sqrt_m = 0.05;
  double sigma_yaw_per_sqrt_m_rad = 0.02;
  double sigma_yaw_per_rad = 0.06;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"field_of_view_deg", "deg", 1, 360, "of a scanner whose lines do not tell it"},
          self.field_of_view_deg);
    visit(Field{"no_return_m", "m", 0.1, 1e6, "a reading from here on is none; scanners then show 81.83 m"},
          self.no_return_m);
    visit(Field{"largest_delay_s", "s", 0, 1e9, "a line that is stamped later than this is refused"},
          self.largest_delay_s);
    visit(Field{"sigma_xy_per_sqrt_m", "m/sqrt(m)", 0, 10, "noise of the wheels, for mission.yaml"},
          self.sigma_xy_per_sqrt_m);
    visit(Field{"sigma_yaw_per_sqrt_m_rad", "rad/sqrt(m)", 0, 10, "the same; measured over 325 m of `aces`"},
          self.sigma_yaw_per_sqrt_m_rad);
    visit(Field{"sigma_yaw_per_rad", "rad/sqrt(rad)", 0, 10, "the same, of turning"}, self.sigma_yaw_per_rad);
  }
};

/// Refuses (InputError) a log without scans, lines that end early, numbers that are none, and times that
/// jump back by more than the largest delay. Other lines are skipped.
ImportedMission read_carmen(const Text& text, const std::string& robot, const CarmenParams& params = {});

}  // namespace radioslam
