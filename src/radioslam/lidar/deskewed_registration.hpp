// Deskews scans by the motion that their registration found, and registers them again.
//
// A scan deskewed by a wrong velocity is still registered right in the middle of its sweep. Motion is
// therefore measured from middle to middle; errors between stamps would alternate in sign and never decay.
#pragma once

#include <optional>

#include "radioslam/lidar/deskewed_scan.hpp"
#include "radioslam/lidar/scan_matcher.hpp"

namespace radioslam {

/// A scan registered to a map.
struct MatchedScan {
  DeskewedScan scan;
  ScanPyramid cloud;
  Registration fit;
};

/// The scan deskewed by its motion since `last` and registered again, or as it is if it has no times or its
/// inlier ratio drops.
MatchedScan deskew_and_match(MatchedScan matched, const LocalMap& map, const ScanOnMap& last,
                             const PosePrior& prior, const ScanMatcher& matcher);

/// The first two scans of a map.
struct MapStart {
  LocalMap map;  ///< holds the first one
  ScanOnMap first;
  ScanPyramid first_cloud;
  MatchedScan next;
};

/// Deskews both by the motion between them, or by the given motion, and registers the second one again;
/// nothing if the first one has no times or the inlier ratio drops. `at`: of the first scan;
/// `travelled_m`: at it.
std::optional<MapStart> deskew_map_start(DeskewedScan first, const ScanOnMap& at, MatchedScan next,
                                         const PosePrior& prior, double travelled_m,
                                         const ScanMatcher& matcher);

}  // namespace radioslam
