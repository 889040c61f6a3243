// Surfels: points with the covariance of their surface and the uncertainty of its normal.
//
// The covariance C is that of the neighbouring points, in m^2 (generalised ICP: Segal, Haehnel, Thrun 2009,
// but with metric scale): narrow across a wall, wide along it, wide all around in foliage. The extent of the
// neighbours along a surface depends on sampling, so the variances l of C about its axes, l0 the smallest,
// are enlarged where they belong to a surface,
//   l' = min(l (1 + (l / (flatness l0))^2), max(l, sigma_along^2)),
// and do not constrain motion along it.
//
// In space, a point with fewer than `min_neighbours` is isolated. Neighbours in a level line, with no clear
// second direction, are one beam's on the ground or the ceiling; they move with the scanner, so the line
// constrains height only, up to the ground's slope `line_slope`. A line that rises is a pole, or a wall seen
// at a small angle. The normal of n neighbours has the variance l0 / (n l1) about either axis, that of a line
// l1 / (n l2); the two are weighted by 1 - l0' / l1' and the rest. None of this applies to planar scanners,
// which sample walls finely and whose wall ends do constrain motion.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "radioslam/base/fields.hpp"

namespace radioslam {

/// Shape of a point's neighbourhood.
enum class SurfelShape : std::uint8_t {
  kIsolated,      ///< too few neighbours, no normal
  kScanLine,      ///< level line of one beam, as on the ground: constrains height only
  kUnstructured,  ///< not clearly flat, or too few neighbours to decide
  kSurface,       ///< clearly flat with the full number of neighbours
};

struct Surfel {
  Eigen::Vector3f position;    ///< metres
  Eigen::Matrix3f covariance;  ///< m^2, positive definite; of the measurement alone if isolated
  float tilt_rad2 = 0;         ///< variance of the surface normal about either axis along the surface
  SurfelShape shape = SurfelShape::kSurface;
};

/// A planar scanner measures in its xy-plane only and does not observe height.
enum class ScannerKind { kSpatial, kPlanar };

struct SurfelParams {
  int neighbours = 10;
  int min_neighbours = 7;  ///< including the point itself
  double max_distance_spacings = 3;
  double flatness = 2;
  double sigma_along_m = 3;
  double sigma_range_m = 0.02;
  double line_slope_rad = 0.2;  ///< including the tilt of the scanner
  double clearly_flat = 10;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(neighbours, "", 4, 50,
                    "number of nearest points from which a surfel's covariance is computed");
    RADIOSLAM_FIELD(min_neighbours, "", 4, 50,
                    "smallest number of neighbours of a surfel with a normal, for scanners in space");
    RADIOSLAM_FIELD(max_distance_spacings, "", 1, 20, "largest distance of a neighbour, in point spacings");
    RADIOSLAM_FIELD(flatness, "", 1, 1000,
                    "ratio to the smallest variance from which a variance is taken to be along a surface");
    RADIOSLAM_FIELD(
        sigma_along_m, "m", 1e-3, 30,
        "largest standard deviation of a surfel along its surface, where it hardly constrains motion");
    RADIOSLAM_BASIC_FIELD(sigma_range_m, "m", 1e-4, 1,
                          "standard deviation of a single range measurement; data sheets say 2 to 3 cm");
    RADIOSLAM_FIELD(line_slope_rad, "rad", 1e-3, 1.5,
                    "standard deviation of the slope of ground on which a beam draws a level line");
    RADIOSLAM_FIELD(clearly_flat, "", 1, 1000,
                    "ratio to the smallest variance from which a neighbourhood is certainly planar; higher "
                    "values trust fewer");
  }
};

/// Rotated by R, then translated by t.
Surfel transformed(const Eigen::Matrix3f& R, const Eigen::Vector3f& t, const Surfel& surfel);

/// A surfel at each of `points`, which are about `spacing_m` apart. Cost: O(n log n).
std::vector<Surfel> measure_surfels(const std::vector<Eigen::Vector3f>& points, double spacing_m,
                                    ScannerKind kind, const SurfelParams& params);

}  // namespace radioslam
