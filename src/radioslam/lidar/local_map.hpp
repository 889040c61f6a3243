// Local map for scan matching: a fine surfel map for registration and a coarse one for relocalisation.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/registration.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"
#include "radioslam/lidar/surfels/surfel_map.hpp"

namespace radioslam {

struct LocalMapParams {
  double source_spacings = 2;
  double max_distance_spacings = 3;
  double coarse_spacings = 3;
  double coarse_max_distance_spacings = 12;
  double memory_m = 30;
  double correlation_ratio = 0.12;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        source_spacings, "", 1, 10,
        "spacing of the scan points that are registered, in map point spacings; higher values are faster");
    RADIOSLAM_FIELD(max_distance_spacings, "", 1, 10,
                    "largest correspondence distance, in map point spacings");
    RADIOSLAM_FIELD(coarse_spacings, "", 1, 100,
                    "point spacing of the coarse alignment in relocalisation, in map point spacings");
    RADIOSLAM_FIELD(coarse_max_distance_spacings, "", 1, 100,
                    "largest correspondence distance of the coarse alignment, in map point spacings");
    RADIOSLAM_BASIC_FIELD(memory_m, "m", 1, 1e6,
                          "travelled distance after which unseen parts of the map are forgotten");
    RADIOSLAM_FIELD(
        correlation_ratio, "", 1e-3, 10,
        "distance within which point errors are correlated, as a fraction of the scan's median range");
  }
};

/// A scan's surfels in its body frame at three densities.
struct ScanPyramid {
  std::vector<Surfel> all;  ///< at the map's spacing
  SurfelSource source;      ///< for registration
  SurfelSource few;         ///< for coarse alignment
  double median_range_m = 0;
};

ScanPyramid scan_pyramid(std::vector<Surfel> surfels, double spacing_m, ScannerKind kind,
                         const LocalMapParams& params);

std::vector<Surfel> transformed(const SE3& T, const std::vector<Surfel>& surfels);

class LocalMap {
 public:
  LocalMap(double spacing_m, const LocalMapParams& params);

  bool empty() const { return fine_.empty(); }
  const SurfelMap& fine() const { return fine_; }
  const SurfelMap& coarse() const { return coarse_; }

  /// Inserts a scan at this pose, after a travelled distance of `travelled_m`, and forgets what was last seen
  /// more than `memory_m` before. Returns the fraction of the scan's surfels that were new.
  double add(const ScanPyramid& cloud, const SE3& T_map_body, double travelled_m);

 private:
  double memory_m_;
  SurfelMap fine_, coarse_;
};

}  // namespace radioslam
