// Position errors of located access points against the positions that the mission states.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Row of access_points.csv.
struct LocatedAccessPoint {
  std::string bssid;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< in the frame of the estimate
  bool is_found = true;                                  ///< neither ambiguous nor loose
};

struct AccessPointErrors {
  std::size_t known = 0;    ///< access points with stated positions
  std::size_t located = 0;  ///< of these, those that were found
  std::optional<ErrorStatistics> errors;
};

/// Errors after the alignment of the estimate with the truth, whose frame is that of the stated positions.
AccessPointErrors access_point_errors(const std::vector<LocatedAccessPoint>& located, const Mission& mission,
                                      const SE3& T_truth_estimate);

}  // namespace radioslam
