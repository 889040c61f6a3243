// Reads and writes a robot's tables imu.csv and gnss.csv.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

/// `t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps`: specific force and angular rate. Refuses rows
/// whose times do not increase, and numbers that are not finite.
std::vector<ImuSample> read_imu(const Text& text);
std::string format_imu(const std::vector<ImuSample>& samples);

/// `t_s,x_m,y_m,z_m,sigma_m`: position fixes, sorted by time, then in the order of the rows.
std::vector<PositionFix> read_fixes(const Text& text);
std::string format_fixes(const std::vector<PositionFix>& fixes);

}  // namespace radioslam
