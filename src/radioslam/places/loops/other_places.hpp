// Places of the target robot, other than the one proposed, where a scan may have been taken.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/places/loops/expected_place.hpp"
#include "radioslam/places/scan_context_index.hpp"

namespace radioslam {

/// Standard deviations within which a place is possible.
inline constexpr double kPossibleSigmas = 4;

/// A keyframe of the target, and where the scan is searched around it.
struct OtherPlace {
  std::size_t keyframe = 0;
  UncertainPose<SE3> T_keyframe_scan;
};

/// Where alternatives of at least this share of the first one's weight expect it, unless the search around
/// the first covers them or the target was nowhere within `reach_m`. Needs the target's sigma_m.
std::vector<OtherPlace> places_expected(const ComparedKeyframes& compared, const ExpectedPlace& expected,
                                        double reach_m, double min_share);

/// The keyframes that look most like j, away from i, from `except` and from each other by the path length
/// `apart_m`. Needs both robots' indices.
std::vector<OtherPlace> places_alike(const ComparedKeyframes& compared, double reach_m, double apart_m,
                                     const std::vector<OtherPlace>& except);

/// Where the target was on other storeys above or below a fit, within `reach_m` of it in the plane, and by
/// more than its height may have drifted. Needs the target's sigma_m.
std::vector<OtherPlace> places_on_other_storeys(const ComparedKeyframes& compared, const SE3& T_i_j,
                                                double storey_m, double reach_m);

/// Where the body of a scan is in the frame of a keyframe that looks alike, by the yaw of their descriptors
/// (`found`: the keyframe among an index, the scan the query).
UncertainPose<SE3> described_pose(const ScanKeyframes& keyframes, const Neighbour& found, int sectors);

}  // namespace radioslam
