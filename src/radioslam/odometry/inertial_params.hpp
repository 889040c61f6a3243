// Parameters of LiDAR-inertial odometry.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/inertial/gravity_alignment.hpp"
#include "radioslam/inertial/imu_consistency.hpp"
#include "radioslam/inertial/imu_outliers.hpp"
#include "radioslam/inertial/inertial_smoother.hpp"
#include "radioslam/inertial/odometry_noise_inflation.hpp"

namespace radioslam {

struct InertialStageParams {
  bool enabled = true;
  double outlier_sigmas = 5;
  double node_s = 2;
  double unmeasured_m = 10;
  double unmeasured_rad = 1;
  double check_s = 120;
  double max_cost_per_step = 60;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(enabled, "", 0, 1, "whether imu.csv is used together with the scans");
    RADIOSLAM_FIELD(
        outlier_sigmas, "", 1, 1e6,
        "standard deviations beyond which a scan's pose is down-weighted in LiDAR-inertial smoothing");
    RADIOSLAM_FIELD(
        node_s, "s", 0, 100,
        "time between the states of LiDAR-inertial smoothing; higher values are faster but less detailed");
    RADIOSLAM_FIELD(unmeasured_m, "m", 1e-2, 1e6,
                    "standard deviation of a scan's position in directions that the scan does not constrain");
    RADIOSLAM_FIELD(
        unmeasured_rad, "rad", 1e-3, 100,
        "standard deviation of a scan's orientation in directions that the scan does not constrain");
    RADIOSLAM_FIELD(check_s, "s", 1, 1e6,
                    "duration of the initial scans, registered without IMU, that the IMU is tested against");
    RADIOSLAM_FIELD(
        max_cost_per_step, "", 1, 1e9,
        "largest smoothing cost per step, expected to be at most 15; above it the IMU is ignored");
  }
};

struct InertialParams {
  InertialStageParams stage;
  ImuNoiseParams noise;
  ImuOutlierParams outliers;
  ImuConsistencyParams consistency;
  GravityAlignmentParams alignment;
  InertialSmootherParams smoother;
  OdometryNoiseInflationParams odometry_noise;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("inertial", self.stage);
    visit("inertial_noise", self.noise);
    visit("imu_outliers", self.outliers);
    visit("imu_consistency", self.consistency);
    visit("gravity_alignment", self.alignment);
    visit("inertial_smoother", self.smoother);
    visit("inertial_odometry", self.odometry_noise);
  }
};

}  // namespace radioslam
