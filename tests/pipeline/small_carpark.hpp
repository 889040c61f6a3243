// A car park small enough for a study of it to be quick.
#pragma once

#include "radioslam/sim/scenarios/carpark.hpp"

namespace radioslam {

inline CarparkParams short_drives() {
  CarparkParams params;
  params.lanes.floor_x_m = 40;
  params.lanes.floor_y_m = 30;
  params.lanes.aisles_along_y = 3;
  params.lanes.aisles_along_x = 3;
  params.drive.path_length_m = 150;
  params.odometry.odometry_rate_hz = 2;
  params.transmitters.access_points = 30;
  return params;
}

}  // namespace radioslam
