// What laser scans say to other robots: closures, and the places by which these recognise them.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/base/strong_id.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/records/record.hpp"

namespace radioslam {

/// A relative pose of two scans, of one robot or of two, that was verified.
struct ScannedClosure {
  RobotIndex robot_i, robot_j;
  Stamp stamp_i, stamp_j;
  SE3 T_i_j;
  SE3::Jacobian covariance = SE3::Jacobian::Identity();
  double inlier_ratio = 0;
  std::optional<double> doubt = {};  ///< probability that another place explains the scan
};

struct ScannedPlace {
  RobotIndex robot;
  Stamp stamp;            ///< of a keyframe
  DescriptorRecord grid;  ///< but for its keyframe's number
};

struct ScannedRecords {
  std::vector<ScannedClosure> closures;
  std::vector<ScannedPlace> places;
};

}  // namespace radioslam
