// Estimates the offset from a gyroscope heading to east from the phone's fused orientation.
//
// The fused heading relies on a magnetometer, which steel disturbs over metres; the gyroscope's heading is
// smooth but has an arbitrary origin and drifts. Their difference over a recording is offset + drift (t -
// middle), fitted robustly (Cauchy weights, iterated). The drift has a prior, since a short walk past steel
// does not constrain it.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/levelling.hpp"
#include "radioslam/mission/phone_motion.hpp"

namespace radioslam {

struct CompassParams {
  double cauchy_scale_rad = 0.1;
  double independent_s = 5;          ///< about 5 m of walking: the extent of one disturbance
  double sigma_heading_rad = 0.2;    ///< typical indoors
  double sigma_drift_radps = 0.001;  ///< 0.06 degrees per second

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        cauchy_scale_rad, "rad", 0.001, 3,
        "scale of the Cauchy loss on compass errors; lower values suppress magnetic disturbances more");
    RADIOSLAM_FIELD(
        independent_s, "s", 0.01, 1000,
        "time after which compass errors are independent; higher values lower the weight of the compass");
    RADIOSLAM_FIELD(sigma_heading_rad, "rad", 0.001, 3,
                    "standard deviation of one independent compass heading");
    RADIOSLAM_FIELD(sigma_drift_radps, "rad/s", 1e-9, 1,
                    "prior standard deviation of the calibrated gyroscope's bias about the vertical");
  }
};

/// Heading from east = gyroscope heading + offset_rad + drift_radps (t - middle).
struct CompassFit {
  Stamp middle;
  double offset_rad = 0;
  double drift_radps = 0;
  double spread_rad = 0;  ///< median absolute residual

  double correction_rad(Stamp stamp) const {
    return offset_rad + drift_radps * seconds_between(middle, stamp);
  }
};

/// Nothing without motion samples or orientations.
std::optional<CompassFit> fit_compass(const std::vector<LevelSample>& motion,
                                      const std::vector<OrientationSample>& orientation,
                                      const CompassParams& params);

}  // namespace radioslam
