// Where a robot's start frame lies in the frame of its position fixes, some of which are grossly wrong.
//
// Yaw and position in the plane follow from any two fixes that lie as far apart as the odometry says. Every
// two of some fixes, evenly spread, give such a hypothesis (its midpoints meet); the best one has the least
//   sum over fixes k of log s_k + log(1 + r_k^2 / s_k^2),   s_k^2 = sigma_k^2 + (drift_share w_k)^2
// with r_k the distance left to fix k and w_k the way from the nearer of the two: Cauchy's likelihood, which
// fixes anywhere cannot bend, with a width for what the odometry drifted. Height: the median of what is left.
// Both frames have their z axis up. The result is a start for a least squares estimate, not one.
// Cost: tried_fixes^2 / 2 times scored_fixes. Refuses fixes no two of which give a direction.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

struct FixAlignmentParams {
  int tried_fixes = 40;
  int scored_fixes = 200;
  double drift_share = 0.03;
  double gate_sigma = 4;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"tried_fixes", "", 2, 1000, "fixes of a robot every two of which are tried as its place"},
          self.tried_fixes);
    visit(Field{"scored_fixes", "", 2, 100000, "fixes by which such places are ranked"}, self.scored_fixes);
    visit(Field{"drift_share", "", 0, 1, "share of the way that odometry may drift meanwhile"},
          self.drift_share);
    visit(Field{"gate_sigma", "sigma", 0.1, 100, "two fixes are tried whose distance is so near odometry's"},
          self.gate_sigma);
  }
};

/// A fix and where odometry has the antenna at its time.
struct FixOfWay {
  Eigen::Vector3d by_odometry_m = Eigen::Vector3d::Zero();  ///< in the start frame
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();     ///< in the fixes' frame
  double sigma_m = 1;
  double way_m = 0;  ///< from the start
};

/// By the best two fixes, near which it is best.
struct FixAlignment {
  SE3 T_fixes_start;  ///< turned about the vertical only
  double way_i_m = 0, way_j_m = 0;
};

/// `fixes` in the order of time.
std::optional<FixAlignment> align_by_fixes(const std::vector<FixOfWay>& fixes,
                                           const FixAlignmentParams& params);

}  // namespace radioslam
