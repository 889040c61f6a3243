// Where north is for a heading that only the gyroscope knows, from the phone's fused orientation.
//
// The fused heading leans on a magnetometer, which steel bends for metres at a time; the gyroscope's heading
// is smooth but starts anywhere and drifts. Their difference over a walk is offset + drift (t - middle), the
// robust fit of which (Cauchy weights, iterated) gives the offset. The drift has a prior, for a short walk
// past steel says nothing about a gyroscope.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/levelling.hpp"
#include "radioslam/mission/phone_motion.hpp"

namespace radioslam {

struct CompassParams {
  double cauchy_scale_rad = 0.1;     ///< what a compass sways by where nothing bends it
  double independent_s = 5;          ///< some five metres of walking: the reach of one piece of steel
  double sigma_heading_rad = 0.2;    ///< indoors
  double sigma_drift_radps = 0.001;  ///< bias left in a calibrated phone gyroscope, 0.06 degrees per second

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"cauchy_scale_rad", "rad", 0.001, 3, "differences well above this count for little"},
          self.cauchy_scale_rad);
    visit(Field{"independent_s", "s", 0.01, 1000, "time after which the compass errs anew"},
          self.independent_s);
    visit(Field{"sigma_heading_rad", "rad", 0.001, 3, "error of one independent compass reading"},
          self.sigma_heading_rad);
    visit(Field{"sigma_drift_radps", "rad/s", 1e-9, 1, "prior of the calibrated gyroscope's bias"},
          self.sigma_drift_radps);
  }
};

/// Heading from east = gyroscope's heading + offset_rad + drift_radps (t - middle).
struct CompassFit {
  Stamp middle;
  double offset_rad = 0;
  double drift_radps = 0;
  double spread_rad = 0;  ///< median absolute difference that is left

  double correction_rad(Stamp stamp) const {
    return offset_rad + drift_radps * seconds_between(middle, stamp);
  }
};

/// Nothing without a motion or an orientation.
std::optional<CompassFit> fit_compass(const std::vector<LevelSample>& motion,
                                      const std::vector<OrientationSample>& orientation,
                                      const CompassParams& params);

}  // namespace radioslam
