// Tests whether IMU samples are consistent with the poses of the same body, before they are used. Detects
// wrong units, a wrong mounting and a time offset.
//
//   accelerometer   median magnitude of the mean over `force_window_s` against gravity
//   gyroscope       rotation s of the poses, g of the gyroscope, over windows of `window_s`:
//                     bias b = median (g - s) / t
//                     r = g - s - b t,  sigma^2 = 2 sigma_turn^2 + (sigma_rotation_ratio |s|)^2
//                     |b| <= sigmas times its stated sigma; median |r|^2 / (3 sigma^2) <= sigmas^2 over the
//                     windows in which either rotates by more than sigmas sigma_turn
//   time offset     that minimises the sum of min(|r|^2 / sigma^2, sigmas^2), if it at least halves the sum
// Medians tolerate occasional wrong poses; without enough rotation the gyroscope is not tested.
// Cost: IMU samples times tested offsets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/inertial/preintegration.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct ImuConsistencyParams {
  double window_s = 0.5;
  double force_window_s = 1;
  double sigma_turn_rad = 0.02;
  double sigma_rotation_ratio = 0.1;
  double sigmas = 5;
  int min_rotation_windows = 5;
  double max_gravity_error_mps2 = 1;
  double max_time_offset_s = 1;
  double time_offset_step_s = 0.05;
  double max_ignored_offset_s = 0.1;
  double max_ignored_offset_steps = 0.75;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(window_s, "s", 0.01, 100,
                    "duration over which rotations of gyroscope and scans are compared");
    RADIOSLAM_FIELD(force_window_s, "s", 0.01, 100, "duration over which the accelerometer is averaged");
    RADIOSLAM_FIELD(sigma_turn_rad, "rad", 1e-4, 1, "standard deviation of the rotation of a scan's pose");
    RADIOSLAM_FIELD(sigma_rotation_ratio, "", 0, 1,
                    "standard deviation of a rotation between scans as a fraction of its angle");
    RADIOSLAM_FIELD(sigmas, "", 1, 1000,
                    "standard deviations that rotation errors and the gyroscope bias may have; higher values "
                    "accept more");
    RADIOSLAM_FIELD(min_rotation_windows, "", 1, 1e6,
                    "smallest number of windows with rotation; with fewer the gyroscope is not tested");
    RADIOSLAM_FIELD(max_gravity_error_mps2, "m/s^2", 0.01, 100,
                    "largest difference between the mean specific force and gravity, in magnitude");
    RADIOSLAM_FIELD(max_time_offset_s, "s", 0, 60,
                    "largest time offset between IMU and scans that is searched");
    RADIOSLAM_FIELD(time_offset_step_s, "s", 1e-3, 10, "step of the time offset search");
    RADIOSLAM_FIELD(max_ignored_offset_s, "s", 0, 60, "time offset between IMU and scans that is tolerated");
    RADIOSLAM_FIELD(max_ignored_offset_steps, "", 0, 100,
                    "tolerated time offset in intervals between poses, where that is larger");
  }
};

/// Describes the inconsistency, in words that follow a robot's name; nothing if the samples may be used.
std::optional<std::string> find_inconsistency(const Trajectory<SE3>& poses,
                                              const std::vector<ImuSample>& samples,
                                              const ImuNoiseParams& noise,
                                              const ImuConsistencyParams& params);

}  // namespace radioslam
