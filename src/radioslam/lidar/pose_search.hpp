// Scan-to-map registration: from a good initial pose, from several hypotheses, or by a search over a window.
//
// A search scores each hypothesis by how many points of a thinned scan have a surfel of the coarse map
// nearby, aligns the best ones on the coarse map and then on the fine one, and keeps that with the highest
// inlier ratio.
#pragma once

#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/registration.hpp"
#include "radioslam/lidar/submap.hpp"

namespace radioslam {

/// Registration from `prior.pose`, which may displace points by `deviation_m`.
Registration register_near(const LocalMap& map, const ScanPyramid& scan, const PosePrior& prior,
                           double deviation_m, ScannerKind kind, const RegistrationParams& params,
                           double min_correspondence_ratio = 0);

/// Registration from `start` instead of `prior.pose`.
Registration register_at(const LocalMap& map, const ScanPyramid& scan, const SE3& start,
                         const PosePrior& prior, double deviation_m, ScannerKind kind,
                         const RegistrationParams& params);

/// The `count` initial poses at which the thinned scan overlaps the map best, best first; ties keep their
/// order.
std::vector<SE3> best_overlapping(const LocalMap& map, const ScanPyramid& scan,
                                  const std::vector<SE3>& starts, std::size_t count);

/// Registers from each of `starts` in order until one reaches the inlier ratio `enough_ratio`; if none does,
/// returns the best.
Registration register_best_of(const LocalMap& map, const ScanPyramid& scan, const std::vector<SE3>& starts,
                              double enough_ratio, ScannerKind kind, const RegistrationParams& params);

/// Where a scan is searched that does not fit at its predicted pose.
struct Relocalisation {
  SE3 last;  ///< pose of the scan before
  SE3 predicted;
  std::size_t max_aligned;  ///< number of hypotheses that are registered
  double enough_ratio;      ///< inlier ratio that ends the search
};

/// The best registration from poses of a robot that moved otherwise than predicted: it stopped or slowed
/// down, or turned more or less.
Registration relocalise(const LocalMap& map, const ScanPyramid& scan, const Relocalisation& search,
                        ScannerKind kind, const RegistrationParams& params);

struct PoseSearchParams {
  double sigmas = 3;
  int max_starts = 4000;
  int max_aligned = 8;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(sigmas, "", 0.5, 10,
                    "half width of the search window, in standard deviations of the pose estimate");
    RADIOSLAM_FIELD(max_starts, "", 1, 1e6,
                    "largest number of initial poses scored per search; wider windows use larger steps");
    RADIOSLAM_FIELD(
        max_aligned, "", 1, 1000,
        "number of initial poses that are registered, the best scores first; higher values are slower");
  }
};

/// Result of a search: where the scan fits, by inlier ratio, best first; at least one. They are distinct: any
/// two displace the scan, at its median range, by more than the fine map's correspondence distance.
struct PoseSearch {
  std::vector<Registration> fits;

  const Registration& best() const { return fits.front(); }
};

/// Searches the horizontal and yaw uncertainty of `guess`.
PoseSearch search_pose(const Submap& map, const ScanPyramid& scan, const UncertainPose<SE3>& guess,
                       ScannerKind kind, const PoseSearchParams& search, const RegistrationParams& params);

}  // namespace radioslam
