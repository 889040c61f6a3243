// A point of a surface with how the surface lies about it: what clouds are registered by.
//
// The covariance C is that of the neighbouring points: narrow across a wall, wide along it, wide all around
// in foliage. With it two clouds need no point measured twice (generalised ICP: Segal, Haehnel, Thrun 2009).
// Unlike there its scale is kept, in m^2, so that the information of a registration has a unit.
// Where the neighbours end along a wall tells of the sampling, not of the wall: taken as a variance it would
// hold a scan to the points it happens to meet, and promise centimetres along a corridor without features.
// So the variances l of C about its axes, l0 the smallest, grow where they are a surface's,
//   l' = min(l (1 + (l / (flatness l0))^2), max(l, sigma_along^2)).
// A point that stands alone, in space with fewer than `fewest_neighbours`, knows of no surface. Nor do
// neighbours in a level line, of which none beside it makes a surface beyond doubt: they are one beam's on
// the ground far ahead, or the ceiling, and go with the scanner. Taken for a surface they would say that it
// stands. They tell of height alone, on ground that slopes by `line_slope`. A line that rises over many beams
// is a pole, or a wall met under a small angle. A normal from n neighbours leans by a variance of l0 / (n l1)
// about either axis, a line by l1 / (n l2): the first counts 1 - l0' / l1', the second the rest. All this
// holds for scans of space; a plane's scan samples its walls finely, and the ends of what it sees of them do
// tell.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "radioslam/base/fields.hpp"

namespace radioslam {

/// What the points about a point tell of its surface.
enum class SurfelShape : std::uint8_t {
  kPoint,    ///< nothing: it stands alone
  kLine,     ///< its height: it stands in a level line, as a beam draws on the ground
  kBlob,     ///< a line or a cloud, or too few points to tell from one
  kSurface,  ///< clearly flat, by as many neighbours as are looked for
};

struct Surfel {
  Eigen::Vector3f position;    ///< metres
  Eigen::Matrix3f covariance;  ///< m^2, positive definite; of the measurement alone where nothing shows
  float tilt_rad2 = 0;         ///< variance of the surface's normal about either axis along it
  SurfelShape shape = SurfelShape::kSurface;
};

/// Does a scanner measure in its xy-plane only? Then heights tell nothing.
enum class ScannerKind { kSpatial, kPlanar };

struct SurfelParams {
  int neighbours = 10;          ///< so many points about a point tell its surface
  int fewest_neighbours = 7;    ///< the point itself among them; fewer tell nothing, in space
  double reach_spacings = 3;    ///< neighbours beyond so many spacings do not
  double flatness = 2;          ///< a variance so many times the smallest is that of a surface
  double sigma_along_m = 3;     ///< along a surface, which tells nothing there
  double sigma_range_m = 0.02;  ///< of a single measurement: 2 to 3 cm in data sheets
  double line_slope_rad = 0.2;  ///< of the ground on which a beam draws a level line, and of the scanner
  double clearly_flat = 10;  ///< a variance so many times the smallest is that of a surface beyond doubt, of
                             ///< all its neighbours

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"neighbours", "", 4, 50, "points about a point that tell its surface"}, self.neighbours);
    visit(Field{"fewest_neighbours", "", 4, 50, "fewer tell nothing of a surface, in space"},
          self.fewest_neighbours);
    visit(Field{"reach_spacings", "", 1, 20, "no neighbour is farther, in spacings of the points"},
          self.reach_spacings);
    visit(Field{"flatness", "", 1, 1000, "a variance so many times the smallest is that of a surface"},
          self.flatness);
    visit(Field{"sigma_along_m", "m", 1e-3, 30, "along a surface, at most: it tells nothing there"},
          self.sigma_along_m);
    visit(Field{"sigma_range_m", "m", 1e-4, 1, "noise of a single measurement; data sheets say 2 to 3 cm"},
          self.sigma_range_m);
    visit(Field{"line_slope_rad", "rad", 1e-3, 1.5, "slope of the ground that a beam draws a level line on"},
          self.line_slope_rad);
    visit(Field{"clearly_flat", "", 1, 1000, "and one so many times, beyond doubt"}, self.clearly_flat);
  }
};

/// Turned, then moved.
Surfel transformed(const Eigen::Matrix3f& R, const Eigen::Vector3f& t, const Surfel& surfel);

/// A surfel at each of `points`, which lie about `spacing_m` apart. Cost: n log n.
std::vector<Surfel> measure_surfels(const std::vector<Eigen::Vector3f>& points, double spacing_m,
                                    ScannerKind kind, const SurfelParams& params);

}  // namespace radioslam
