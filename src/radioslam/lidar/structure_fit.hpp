// How well the structure of a scan fits a map: that part of it which determines where in the plane it was
// taken.
//
// Ground fits ground anywhere. Of every surfel with a normal counts the share of its information on x and y,
//   h = (W_xx + W_yy) / tr W,  W = C^-1,
// next to nothing on the ground, all of it on walls, and two thirds where there is no clear plane.
//   ratio = sum h rho / sum h,  rho: Geman-McClure weight of the correspondence, as in registration.hpp
#pragma once

#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/surfels/surfel_columns.hpp"

namespace radioslam {

/// h; 0 without a normal.
double horizontal_share(const Surfel& surfel);

/// Sum of h: the number of surfels that determine the position. The body's z-axis must be about vertical.
double structure_of(const ScanPyramid& scan);

/// The ratio, 0 to 1. `loss_scale`: as in RegistrationParams.
double structure_fit(const SurfelColumns& map, const ScanPyramid& scan, const SE3& T_map_scan,
                     ScannerKind kind, double loss_scale);

}  // namespace radioslam
