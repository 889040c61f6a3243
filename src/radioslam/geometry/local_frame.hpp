// Places on the earth as coordinates about one of them: east, north and up (metres) in the plane that touches
// the ellipsoid of WGS 84 at an origin.
//
// A place at latitude p, longitude l and height h is, from the earth's centre,
//   ((N + h) cos p cos l, (N + h) cos p sin l, ((1 - e^2) N + h) sin p),   N = a / sqrt(1 - e^2 sin^2 p)
// with a = 6378137 m and e^2 = f (2 - f), f = 1 / 298.257223563 (NIMA TR8350.2); what it is less the origin,
// turned so that x is east and z up there.
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// Height is above the ellipsoid.
struct GeodeticPlace {
  double latitude_rad = 0, longitude_rad = 0, height_m = 0;
};

/// From the earth's centre; x to the Greenwich meridian on the equator, z to the north pole.
Eigen::Vector3d earth_centred_m(const GeodeticPlace& place);

Eigen::Vector3d east_north_up_m(const GeodeticPlace& origin, const GeodeticPlace& place);

}  // namespace radioslam
