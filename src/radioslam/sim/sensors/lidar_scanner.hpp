// Simulated rotating LiDAR on a moving robot, by ray casting.
//
// A scan takes 1 / lidar_rotation_hz from its stamp on. The azimuth turns counter-clockwise from -pi (the
// body's back) to pi, with measurements within the field of view about body x, all beams of one azimuth at
// once. Each point is measured from the true pose at its own time and given in the body frame at that time,
// without deskewing. Noise is along the beam; surfaces closer than lidar_min_range_m or beyond the range, and
// dropouts, give no point. Every scan has its own random stream, so it does not depend on when and by which
// thread it is read. Cost of a scan: one ray per beam and azimuth, at most a microsecond each.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/mission/lidar.hpp"
#include "radioslam/sim/motion/true_motion.hpp"
#include "radioslam/sim/worlds/ray_world.hpp"

namespace radioslam {

struct LidarScannerParams {
  int lidar_beams = 0;
  double lidar_lowest_deg = 0;
  double lidar_highest_deg = 0;
  int lidar_azimuth_steps = 900;
  double lidar_rotation_hz = 10;
  double lidar_view_deg = 360;
  double lidar_min_range_m = 0.5;
  double lidar_sigma_m = 0.02;
  double lidar_dropout_ratio = 0;
  double lidar_height_m = 0.6;
  double range_m = 30;  ///< the scenario's lidar_range_m, hence not listed here

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(lidar_beams, "", 0, 128,
                          "number of LiDAR beams; 0: no scans, 1: planar scanner, 16: VLP-16, 64: HDL-64E");
    RADIOSLAM_FIELD(lidar_lowest_deg, "deg", -90, 90,
                    "elevation of the lowest beam; if not below the highest: -15 to 15 deg up to 32 beams, "
                    "-24.8 to 2 deg beyond");
    RADIOSLAM_FIELD(lidar_highest_deg, "deg", -90, 90, "elevation of the highest beam; see lidar_lowest_deg");
    RADIOSLAM_FIELD(lidar_azimuth_steps, "", 1, 100000,
                    "number of azimuths over the field of view; a VLP-16 has 1800");
    RADIOSLAM_FIELD(lidar_rotation_hz, "Hz", 0.1, 100, "scans per second");
    RADIOSLAM_FIELD(lidar_view_deg, "deg", 1, 360, "horizontal field of view about body x");
    RADIOSLAM_FIELD(lidar_min_range_m, "m", 0, 100, "smallest measurable range");
    RADIOSLAM_FIELD(lidar_sigma_m, "m", 0, 10, "standard deviation of ranges; 0.02 for an HDL-64E");
    RADIOSLAM_FIELD(lidar_dropout_ratio, "", 0, 1, "ratio of points that are not returned");
    RADIOSLAM_FIELD(lidar_height_m, "m", 0, 100, "height of the LiDAR above the body's origin");
  }
};

/// Elevations of all beams, increasing and evenly spaced; a single beam is horizontal, or in the middle if
/// the ends are given.
std::vector<double> beam_elevations_rad(const LidarScannerParams& params);

/// One scan that begins at `stamp`.
LidarScan sweep(const RayWorld& world, const TrueMotion& motion, const LidarScannerParams& params,
                Stamp stamp, Rng rng);

/// All scans that begin and end during the motion, each computed when it is read; none without beams.
LidarLog scan_along(std::shared_ptr<const RayWorld> world, std::shared_ptr<const TrueMotion> motion,
                    const LidarScannerParams& params, const Rng& rng);

}  // namespace radioslam
