// Keys of the odometry noise in mission.yaml.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "radioslam/mission/mission.hpp"

namespace radioslam {

inline constexpr std::array<std::pair<std::string_view, double OdometryNoise::*>, 6> kOdometryNoiseFields = {
    {{"sigma_xy_per_sqrt_m", &OdometryNoise::sigma_xy_per_sqrt_m},
     {"sigma_yaw_per_sqrt_m_rad", &OdometryNoise::sigma_yaw_per_sqrt_m_rad},
     {"sigma_yaw_per_rad", &OdometryNoise::sigma_yaw_per_rad},
     {"sigma_z_per_sqrt_m", &OdometryNoise::sigma_z_per_sqrt_m},
     {"sigma_yaw_drift_per_m_rad", &OdometryNoise::sigma_yaw_drift_per_m_rad},
     {"sigma_scale", &OdometryNoise::sigma_scale}}};

}  // namespace radioslam
