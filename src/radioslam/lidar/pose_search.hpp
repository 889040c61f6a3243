// Where a scan lies on a map: from a start that is nearly right, or from many of which one is near enough.
//
// From afar a start is first judged by how many of a few points meet the map at all; the best of them are
// aligned on the coarse map, then on the fine one, and the one that fits best there is taken.
#pragma once

#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/registration.hpp"

namespace radioslam {

/// From `prior.pose`, which may put points wrong by `deviation_m`.
Registration register_near(const LocalMap& map, const ScanCloud& scan, const PosePrior& prior,
                           double deviation_m, ScannerKind kind, const RegistrationParams& params,
                           double least_met_share = 0);

/// Likewise from a start that is not the prior's.
Registration register_at(const LocalMap& map, const ScanCloud& scan, const SE3& start, const PosePrior& prior,
                         double deviation_m, ScannerKind kind, const RegistrationParams& params);

/// The starts at which most of a few points meet the map, the best first; of equal ones the earlier.
std::vector<SE3> most_promising(const LocalMap& map, const ScanCloud& scan, const std::vector<SE3>& starts,
                                std::size_t count);

/// From each of `starts` in turn, until one fits by `enough_share` of the points; else the one that fits
/// best.
Registration register_from(const LocalMap& map, const ScanCloud& scan, const std::vector<SE3>& starts,
                           double enough_share, ScannerKind kind, const RegistrationParams& params);

struct PoseSearchParams {
  double sigmas = 3;       ///< of the window
  int most_starts = 4000;  ///< a wider window is searched in larger steps
  int most_aligned = 8;    ///< starts that are aligned

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"sigmas", "", 0.5, 10, "half the window of starts, in standard deviations of the estimate"},
          self.sigmas);
    visit(Field{"most_starts", "", 1, 1e6, "a wider window is searched in larger steps"}, self.most_starts);
    visit(Field{"most_aligned", "", 1, 1000, "the best starts, which are aligned"}, self.most_aligned);
  }
};

/// What a search found. Places apart are so by more than the fine map's reach, or turned by as much at the
/// scan's median range.
struct PoseSearch {
  Registration best;
  double next_share = 0;  ///< of the points that fit at the best place apart from it
};

/// Starts within the guess's horizontal and yaw uncertainty.
PoseSearch search_pose(const LocalMap& map, const ScanCloud& scan, const UncertainPose<SE3>& guess,
                       ScannerKind kind, const PoseSearchParams& search, const RegistrationParams& params);

}  // namespace radioslam
