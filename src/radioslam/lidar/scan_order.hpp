// Do a scan's points lie on surfaces, or anywhere?
//
//   C_k     covariance of the `neighbours` points nearest to point k, however far they are; of half as many
//           of a scanner in the plane: a line takes fewer points than a surface
//   order   share of the k at which C_k's largest eigenvalue is more than `elongation` times its smallest
//           (in the plane: within it)
//
// Walls, floors and poles are long one way and thin another; of points thrown anywhere, twenty have ratios of
// two to eight. Such points lie near everything, and everything near them: how well a scan fits does not tell
// them from a map. Measured: 0.33 to 0.97 in halls, corridors, streets and among trees, at most 0.03 of
// noise. Cost: a k-d tree and `most_points` searches in it.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/lidar/surfel.hpp"

namespace radioslam {

struct ScanOrderParams {
  int neighbours = 20;
  double elongation = 12;
  int most_points = 300;      ///< are looked at, evenly among all
  double least_share = 0.15;  ///< a scan with less order than this is noise

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"neighbours", "", 4, 50, "points about a point that tell whether it lies on a surface"},
          self.neighbours);
    visit(Field{"elongation", "", 1, 1e6, "variances along and across a surface have at least this ratio"},
          self.elongation);
    visit(Field{"most_points", "", 1, 1e6, "that many points of a scan are looked at"}, self.most_points);
    visit(Field{"least_share", "", 0, 1, "a scan fewer of whose points lie on surfaces is noise"},
          self.least_share);
  }
};

/// Nought of fewer points than twice the neighbours: the nearest ones would be all of them.
double scan_order(const std::vector<Surfel>& surfels, ScannerKind kind, const ScanOrderParams& params);

}  // namespace radioslam
