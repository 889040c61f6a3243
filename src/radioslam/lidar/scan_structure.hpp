// Fraction of a scan's points with a planar or linear neighbourhood: distinguishes surfaces from noise.
//
//   C_k        covariance of the `neighbours` points nearest to point k at any distance; half as many for a
//              planar scanner
//   planarity  fraction of the k whose C_k has a largest eigenvalue above `elongation` times the smallest
//              (for a planar scanner: within the plane)
//
// Noise points lie near any map, so an inlier ratio does not reveal them. Measured: 0.33 to 0.97 in halls,
// corridors, streets and among trees, at most 0.03 for noise. Cost: a k-d tree and `max_points` searches.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

struct ScanStructureParams {
  int neighbours = 20;
  double elongation = 12;
  int max_points = 300;
  double min_structured_ratio = 0.15;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(neighbours, "", 4, 50,
                    "number of nearest points by which a point is tested for lying on a surface");
    RADIOSLAM_FIELD(elongation, "", 1, 1e6, "smallest ratio of the variances along and across a surface");
    RADIOSLAM_FIELD(max_points, "", 1, 1e6, "number of points of a scan that are tested, evenly spread");
    RADIOSLAM_FIELD(
        min_structured_ratio, "", 0, 1,
        "smallest fraction of a scan's points that lie on surfaces; scans below it are taken for noise");
  }
};

/// Zero for fewer points than twice the neighbours, too few to have a local neighbourhood.
double planarity(const std::vector<Surfel>& surfels, ScannerKind kind, const ScanStructureParams& params);

/// Keeps scans without structure from starting a map or being searched on one. After more than `max_rejected`
/// of them in succession the surroundings are taken to be unstructured, and they are admitted.
class StructureGate {
 public:
  StructureGate(ScannerKind kind, const ScanStructureParams& params, int max_rejected)
      : kind_(kind), params_(params), max_rejected_(max_rejected) {}

  bool admits(const std::vector<Surfel>& scan);
  /// A scan was registered.
  void reset() { unstructured_ = 0; }

 private:
  ScannerKind kind_;
  ScanStructureParams params_;
  int max_rejected_;
  int unstructured_ = 0;  ///< scans in succession
};

}  // namespace radioslam
