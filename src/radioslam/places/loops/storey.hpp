// Storeys of a building that may look the same: how high they are by what a scan sees, and how likely a place
// is on another one than where it is predicted.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/lidar/local_map.hpp"

namespace radioslam {

/// The least height of a storey that the scan may have been taken on; nothing in the open. It is on one if
/// most points are within 30 m, or if it sees a ceiling: of what is overhead and no wall, much lies in one
/// level plane. The body's z-axis must be about vertical.
std::optional<double> storey_height_m(const ScanPyramid& scan);

/// m(d) of loop_verification.hpp, of d^2.
double prior_density(double squared_distance);

/// One of the heights where a place may be, by a prediction.
struct ExpectedHeight {
  double z_m = 0;
  double share = 1;  ///< probability
};

/// Density of the most likely storeys above and below the height `z_m`, over its own; each expected height
/// has the standard deviation `sigma_m`.
double other_storeys(double storey_m, double z_m, const std::vector<ExpectedHeight>& expected,
                     double sigma_m);

}  // namespace radioslam
