// A robot's own tables beside its odometry and WiFi: imu.csv (checked only) and gnss.csv.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/text.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

/// Refuses inertial rows that do not run forward in time, and numbers that are not finite.
void check_inertial(const Text& text);

/// `t_s,x_m,y_m,z_m,sigma_m`: position fixes, in the order of time, then of the rows.
std::vector<PositionFix> read_fixes(const Text& text);
std::string format_fixes(const std::vector<PositionFix>& fixes);

}  // namespace radioslam
