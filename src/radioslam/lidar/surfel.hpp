// A point of a surface with how the surface lies about it: what clouds are registered by.
//
// The covariance C is that of the neighbouring points: narrow across a wall, wide along it, wide all around
// in foliage. With it two clouds need no point measured twice (generalised ICP: Segal, Haehnel, Thrun 2009).
// Unlike there its scale is kept, in m^2, so that the information of a registration has a unit.
// Where the neighbours end along a wall tells of the sampling, not of the wall: taken as a variance it would
// hold a scan to the points it happens to meet, and promise centimetres along a corridor without features.
// So the variances l of C about its axes, l0 the smallest, grow where they are a surface's,
//   l' = min(l (1 + (l / (flatness l0))^2), max(l, sigma_along^2)).
// A point that stands alone tells nothing. Neighbours in a level line are one beam's on a surface of unknown
// slope, the ground far ahead, say: such a surfel is free all around. A line that rises over many beams is a
// pole. All this holds for scans of space; a plane's scan samples its walls finely, and the ends of what it
// sees of them do tell.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/base/fields.hpp"

namespace radioslam {

struct Surfel {
  Eigen::Vector3f position;    ///< metres
  Eigen::Matrix3f covariance;  ///< m^2, positive definite
};

/// Does a scanner measure in its xy-plane only? Then heights tell nothing.
enum class ScannerKind { kSpatial, kPlanar };

struct SurfelParams {
  int neighbours = 10;          ///< so many points about a point tell its surface
  double reach_spacings = 3;    ///< neighbours beyond so many spacings do not
  double flatness = 2;          ///< a variance so many times the smallest is that of a surface
  double sigma_along_m = 3;     ///< along a surface, which tells nothing there
  double sigma_range_m = 0.02;  ///< of a single measurement: 2 to 3 cm in data sheets

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"neighbours", "", 4, 50, "points about a point that tell its surface"}, self.neighbours);
    visit(Field{"reach_spacings", "", 1, 20, "no neighbour is farther, in spacings of the points"},
          self.reach_spacings);
    visit(Field{"flatness", "", 1, 1000, "a variance so many times the smallest is that of a surface"},
          self.flatness);
    visit(Field{"sigma_along_m", "m", 1e-3, 1000, "along a surface, at most: it tells nothing there"},
          self.sigma_along_m);
    visit(Field{"sigma_range_m", "m", 1e-4, 1, "noise of a single measurement; data sheets say 2 to 3 cm"},
          self.sigma_range_m);
  }
};

/// A surfel at each of `points`, which lie about `spacing_m` apart. Cost: n log n.
std::vector<Surfel> measure_surfels(const std::vector<Eigen::Vector3f>& points, double spacing_m,
                                    ScannerKind kind, const SurfelParams& params);

}  // namespace radioslam
