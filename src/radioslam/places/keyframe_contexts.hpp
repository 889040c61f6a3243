// Scan Contexts of a robot's keyframes.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/places/loops/scan_loop.hpp"
#include "radioslam/places/scan_context.hpp"
#include "radioslam/places/scan_context_index.hpp"

namespace radioslam {

/// Path length from the first keyframe to each; three standard deviations for a step whose heading is
/// unknown.
std::vector<double> path_lengths(const ScanKeyframes& keyframes);

/// Standard deviation per axis of the motion between two keyframes by the robot's odometry, metres; 2 % of
/// the way where its covariance is not known. Linear in the keyframes between them.
double odometry_sigma_m(const ScanKeyframes& keyframes, const std::vector<double>& path_m, std::size_t a,
                        std::size_t b);

/// Horizontal range within which most points of the keyframes lie, between 3 and 80 m; 0 without points.
double context_range(const ScanKeyframes& keyframes);

/// One per keyframe: heights of the points of its scan. A planar scanner sees little at once: its grids show
/// which bins are occupied by all scans within `submap_m` of path.
std::vector<ScanContext> keyframe_contexts(const ScanKeyframes& keyframes, const std::vector<double>& path_m,
                                           double range_m, double submap_m, const ScanContextParams& params);

/// The same to be searched.
ScanContextIndex keyframe_index(const ScanKeyframes& keyframes, const std::vector<double>& path_m,
                                double range_m, double submap_m, const PlaceDescriptorParams& params);

}  // namespace radioslam
