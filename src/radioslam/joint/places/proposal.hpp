// A pair of keyframes of different robots that is proposed for registration.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/places/loops/expected_place.hpp"

namespace radioslam {

/// Keyframe j of robot b on a submap around keyframe i of robot a.
struct Proposal {
  std::size_t a = 0, b = 0, i = 0, j = 0;
  UncertainPose<SE3> T_i_j;
  bool anywhere = false;  ///< by descriptors alone
  double descriptor_distance = 1;
  std::size_t alignment = 0;  ///< that predicts T_i_j: 0, or 1 + the number of an alternative
  double alignment_weight = 1;
  std::vector<ExpectedPlace::Alternative> alternatives = {};  ///< predicted by the other likely alignments
};

inline ExpectedPlace expected_place(const Proposal& pair) {
  return {pair.T_i_j, pair.alignment_weight, pair.alternatives, pair.anywhere};
}

/// Standard deviation of the relative position in the plane, per axis.
double horizontal_sigma(const UncertainPose<SE3>& T);

}  // namespace radioslam
