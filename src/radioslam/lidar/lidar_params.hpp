// Parameters of LiDAR odometry (lidar_odometry.hpp) and of scanner detection (scan_matcher.hpp).
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/registration.hpp"
#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/lidar/scan_structure.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

struct LidarOdometryParams {
  double spacing_m = 0;
  double spacing_ratio = 0.05;
  double min_spacing_m = 0.05;
  double max_spacing_m = 0.5;
  double first_sigma_m = 0.5;
  double first_sigma_rad = 0.2;
  double min_sigma_m = 0.02;
  double min_sigma_rad = 0.005;
  double level_sigma_m = 0.1;
  double level_sigma_rad = 0.05;
  double prior_factor = 10;  ///< wide: prediction errors are systematic, not independent from scan to scan
  double error_smoothing = 0.05;
  double relocalise_below_ratio = 0.9;  ///< also what a deskewed scan must keep of its inlier ratio
  int max_aligned = 5;
  double min_insert_ratio = 0.8;
  double min_inlier_ratio = 0.15;
  double min_nominal_ratio = 0.5;
  double min_first_inlier_ratio = 0.5;
  int max_lost_scans = 10;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(spacing_m, "m", 0, 10,
                          "spacing of the map's points; 0 derives it from the ranges of the first scans");
    RADIOSLAM_FIELD(spacing_ratio, "", 0.001, 1,
                    "map point spacing as a fraction of the first scans' median range; at most 0.12 m for a "
                    "planar scanner with odometry");
    RADIOSLAM_FIELD(min_spacing_m, "m", 0.001, 10, "smallest map point spacing chosen automatically");
    RADIOSLAM_FIELD(max_spacing_m, "m", 0.001, 10, "largest map point spacing chosen automatically");
    RADIOSLAM_FIELD(first_sigma_m, "m", 1e-3, 10,
                    "standard deviation of the predicted translation before any prediction was tested");
    RADIOSLAM_FIELD(first_sigma_rad, "rad", 1e-3, 3,
                    "standard deviation of the predicted rotation before any prediction was tested");
    RADIOSLAM_FIELD(min_sigma_m, "m", 1e-4, 10,
                    "lower bound on the standard deviation of the predicted translation");
    RADIOSLAM_FIELD(min_sigma_rad, "rad", 1e-5, 3,
                    "lower bound on the standard deviation of the predicted rotation");
    RADIOSLAM_FIELD(level_sigma_m, "m", 1e-4, 100,
                    "standard deviation of the unobserved height of a robot with a planar scanner");
    RADIOSLAM_FIELD(level_sigma_rad, "rad", 1e-5, 3,
                    "standard deviation of the unobserved roll and pitch of a robot with a planar scanner");
    RADIOSLAM_FIELD(
        prior_factor, "", 1, 1000,
        "standard deviation of the pose prior in prediction errors; higher values trust scans more");
    RADIOSLAM_FIELD(error_smoothing, "", 1e-3, 1,
                    "weight of the newest prediction error in the running mean; higher values adapt faster");
    RADIOSLAM_FIELD(relocalise_below_ratio, "", 0, 1,
                    "fraction of the nominal inlier ratio below which a scan is relocalised; higher values "
                    "search more often");
    RADIOSLAM_FIELD(max_aligned, "", 1, 21,
                    "number of relocalisation hypotheses that are registered, out of 21");
    RADIOSLAM_FIELD(min_insert_ratio, "", 0, 1,
                    "fraction of the nominal inlier ratio that a scan needs to be inserted into the map");
    RADIOSLAM_BASIC_FIELD(min_inlier_ratio, "", 0, 1,
                          "smallest inlier ratio of a registered scan; scans below it count as lost");
    RADIOSLAM_FIELD(
        min_nominal_ratio, "", 0, 1,
        "smallest inlier ratio of a registered scan as a fraction of the nominal one; noise reaches 0.4");
    RADIOSLAM_FIELD(min_first_inlier_ratio, "", 0, 1,
                    "smallest inlier ratio of the second scan on a map, before a nominal ratio is known");
    RADIOSLAM_BASIC_FIELD(max_lost_scans, "", 1, 1e6,
                          "number of lost scans that fit each other, or of missed scan intervals, after "
                          "which a new map is started");
  }
};

struct LidarParams {
  ScanPointParams points;
  SurfelParams surfel;
  RegistrationParams registration;
  LocalMapParams map;
  ScanStructureParams order;
  LidarOdometryParams odometry;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("scan_points", self.points);
    visit("scan_surfels", self.surfel);
    visit("scan_registration", self.registration);
    visit("scan_map", self.map);
    visit("scan_structure", self.order);
    visit("scan_odometry", self.odometry);
  }
};

}  // namespace radioslam
