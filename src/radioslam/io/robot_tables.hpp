// A robot's own tables beside its odometry and WiFi: imu.csv and gnss.csv.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/text.hpp"
#include "radioslam/mission/inertial.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

/// `t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps`: specific force and angular rate. Refuses rows
/// that do not run forward in time, and numbers that are not finite.
std::vector<InertialSample> read_inertial(const Text& text);
std::string format_inertial(const std::vector<InertialSample>& samples);

/// `t_s,x_m,y_m,z_m,sigma_m`: position fixes, in the order of time, then of the rows.
std::vector<PositionFix> read_fixes(const Text& text);
std::string format_fixes(const std::vector<PositionFix>& fixes);

}  // namespace radioslam
