// Aligns a robot's start frame with the frame of its position fixes, some of which may be grossly wrong.
//
// Any two fixes whose distance agrees with odometry determine yaw and horizontal position, by aligning
// direction and midpoint. All pairs among evenly spread fixes are tried as hypotheses; the best one minimises
//   sum over fixes k of log s_k + log(1 + r_k^2 / s_k^2),   s_k^2 = sigma_k^2 + (max_drift_ratio w_k)^2
// with r_k the residual of fix k and w_k the path length from the nearer fix of the pair: a Cauchy
// likelihood, which bounds the influence of outliers, widened by odometry drift. The height offset is the
// median of the height residuals. Both frames have a vertical z axis. The result initialises a least squares
// estimate. Cost: tried_fixes^2 / 2 times scored_fixes. Returns nothing if no pair of fixes determines a
// direction.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

struct FixAlignmentParams {
  int tried_fixes = 40;
  int scored_fixes = 200;
  double max_drift_ratio = 0.03;
  double gate_sigma = 4;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        tried_fixes, "", 2, 1000,
        "number of position fixes per robot from which all pairs are tried as alignment hypotheses");
    RADIOSLAM_FIELD(scored_fixes, "", 2, 100000,
                    "number of position fixes per robot on which alignment hypotheses are scored");
    RADIOSLAM_FIELD(max_drift_ratio, "", 0, 1,
                    "largest odometry drift between position fixes, as a fraction of the path length");
    RADIOSLAM_FIELD(gate_sigma, "sigma", 0.1, 100,
                    "largest difference between fix distance and odometry distance of a pair; higher values "
                    "try more pairs");
  }
};

/// A position fix and the antenna position by odometry at its stamp.
struct FixAlongPath {
  Eigen::Vector3d by_odometry_m = Eigen::Vector3d::Zero();  ///< in the start frame
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();     ///< in the fixes' frame
  double sigma_m = 1;
  double path_m = 0;  ///< path length from the start
};

/// Alignment by the best pair of fixes, and their path lengths; it is most accurate near those.
struct FixAlignment {
  SE3 T_fixes_start;  ///< rotated about the vertical only
  double path_i_m = 0, path_j_m = 0;
};

/// `fixes` in time order.
std::optional<FixAlignment> align_by_fixes(const std::vector<FixAlongPath>& fixes,
                                           const FixAlignmentParams& params);

}  // namespace radioslam
