// A turning laser scanner on a moving robot, by casting rays into a world.
//
// A sweep takes 1 / lidar_rotation_hz from its stamp on. Its azimuth turns counter-clockwise from -pi (the
// body's back) to pi, and measures within the field of view about body x, all beams of one azimuth at once.
// Each point is measured from the true pose at its own time and given in the body frame at that time: raw,
// not corrected for the motion. Noise is along the beam; what is nearer than lidar_min_range_m or beyond the
// range, or drops out, leaves no point. Every scan has a stream of random numbers of its own, so it is the
// same whenever and by whichever thread it is read. Cost of a scan: a ray per beam and azimuth, a microsecond
// or less each.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/mission/lidar.hpp"
#include "radioslam/sim/ray_world.hpp"
#include "radioslam/sim/true_motion.hpp"

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
  double lidar_dropout_share = 0;
  double lidar_height_m = 0.6;
  double range_m = 30;  ///< the scenario's lidar_range_m, so not listed here

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"lidar_beams", "", 0, 128,
                "beams of every robot's LiDAR: 0: no scans; 1: a plane; 16: a VLP-16; 64: an HDL-64E"},
          self.lidar_beams);
    visit(Field{"lidar_lowest_deg", "deg", -90, 90,
                "elevation of the lowest beam; if not below the highest: -15 to 15 up to 32 beams, then "
                "-24.8 to 2"},
          self.lidar_lowest_deg);
    visit(Field{"lidar_highest_deg", "deg", -90, 90, "elevation of the highest beam"},
          self.lidar_highest_deg);
    visit(Field{"lidar_azimuth_steps", "", 1, 100000, "azimuths over the field of view; a VLP-16 has 1800"},
          self.lidar_azimuth_steps);
    visit(Field{"lidar_rotation_hz", "Hz", 0.1, 100, "sweeps per second"}, self.lidar_rotation_hz);
    visit(Field{"lidar_view_deg", "deg", 1, 360, "width of the field of view about body x"},
          self.lidar_view_deg);
    visit(Field{"lidar_min_range_m", "m", 0, 100, "nothing nearer is seen"}, self.lidar_min_range_m);
    visit(Field{"lidar_sigma_m", "m", 0, 10, "noise along a beam; 0.02 is an HDL-64E's"}, self.lidar_sigma_m);
    visit(Field{"lidar_dropout_share", "", 0, 1, "share of the points that do not come back"},
          self.lidar_dropout_share);
    visit(Field{"lidar_height_m", "m", 0, 100, "of the LiDAR over the body's origin"}, self.lidar_height_m);
  }
};

/// Elevation of every beam, rising, evenly spread; a single beam is level, or in the middle where the ends
/// are given.
std::vector<double> beam_elevations_rad(const LidarScannerParams& params);

/// One sweep that begins at `stamp`.
LidarScan sweep(const RayWorld& world, const TrueMotion& motion, const LidarScannerParams& params,
                Stamp stamp, Rng rng);

/// All sweeps that begin and end during the motion, each made when it is read; none without beams.
LidarLog scan_along(std::shared_ptr<const RayWorld> world, std::shared_ptr<const TrueMotion> motion,
                    const LidarScannerParams& params, const Rng& rng);

}  // namespace radioslam
