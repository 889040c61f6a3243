// Scan matching with one scanner: measures the surfels of its scans and registers them to local maps.
#pragma once

#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/deskew.hpp"
#include "radioslam/lidar/lidar_params.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/registration.hpp"
#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

// A deskewed scan: its surfels, when each was measured, and the motion it was deskewed by.

/// A scan's pose on a map.
struct ScanOnMap {
  Stamp stamp, middle_stamp;
  SE3 T_map_body, T_map_middle;  ///< at the stamp and in the middle of the sweep
};

/// Mean twist per second from the middle of one sweep to that of a later one.
SE3::Tangent twist_between(const ScanOnMap& from, const ScanOnMap& to);

struct DeskewedScan {
  Stamp stamp;
  MotionSource source = MotionSource::kConstantVelocity;
  SE3::Tangent twist_per_s = SE3::Tangent::Zero();  ///< by which it was deskewed
  std::vector<Surfel> surfels;                      ///< in the body frame at the stamp
  std::vector<float> times_s;                       ///< of the surfels; empty if unknown
  double middle_s = 0;

  SE3 T_body_middle() const { return SE3::exp(middle_s * twist_per_s); }
  Stamp middle() const { return {stamp.ns + Stamp::from_seconds(middle_s).ns}; }
  ScanOnMap on_map(const SE3& T_map_body) const {
    return {stamp, middle(), T_map_body, T_map_body * T_body_middle()};
  }

  /// Deskews again, by this motion.
  void deskew_with(const SE3::Tangent& is_per_s);
};

/// Properties of a scanner and its surroundings: planar or spatial, and the map point spacing (a fraction of
/// the median range). Determined from kTraitScans scans.
struct ScannerTraits {
  double spacing_m = 0.25;
  ScannerKind kind = ScannerKind::kSpatial;
};

inline constexpr std::size_t kTraitScans = 10;

ScannerTraits scanner_traits(const std::vector<LidarScan>& scans, const LidarParams& params);
/// By scans spread over the log.
ScannerTraits scanner_traits(const LidarLog& log, const LidarParams& params);

class ScanMatcher {
 public:
  ScanMatcher(const ScannerTraits& traits, const LidarParams& params) : traits_(traits), params_(params) {}

  const ScannerTraits& traits() const { return traits_; }
  const LidarParams& params() const { return params_; }

  LocalMap empty_map() const { return {traits_.spacing_m, params_.map}; }

  /// The surfels of points that were deskewed by this twist.
  DeskewedScan measure(Stamp stamp, const ScanPoints& points, const SE3::Tangent& twist_per_s,
                       MotionSource source) const;

  ScanPyramid pyramid_of(const DeskewedScan& scan) const;

  /// Registration from the prior's pose, which may displace points by `deviation_m`.
  Registration register_near(const LocalMap& map, const ScanPyramid& cloud, const PosePrior& prior,
                             double deviation_m, double min_correspondence_ratio = 0) const;

  /// Registration from `start`, which may displace points by `deviation_m`.
  Registration register_at(const LocalMap& map, const ScanPyramid& cloud, const SE3& start,
                           const PosePrior& prior, double deviation_m) const;

  /// With the prior on what a planar scanner does not observe: small motions in height, roll and pitch.
  SE3::Jacobian observable_information(const SE3::Jacobian& information) const;

 private:
  ScannerTraits traits_;
  LidarParams params_;
};

}  // namespace radioslam
