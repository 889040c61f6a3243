// Simulated GNSS receiver at the body's origin: white noise, and episodes of gross errors.
//
//   fix = position + n + e,   n ~ N(0, gnss_sigma_m^2) per axis and fix
//
// e is zero except in episodes where reflections off houses replace the direct signals: there it is one draw
// of N(0, gnss_outlier_m^2) per axis, constant over the episode. Episodes follow a Markov chain of two
// states; they last gnss_outlier_s on average and contain the ratio gnss_outlier_ratio of all fixes. The
// stated sigma is that of n. Fixes are in the truth's frame.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/mission/radio_links.hpp"
#include "radioslam/sim/motion/true_motion.hpp"

namespace radioslam {

struct GnssReceiverParams {
  double gnss_hz = 0;
  double gnss_sigma_m = 1.5;
  double gnss_outlier_ratio = 0.15;
  double gnss_outlier_m = 30;
  double gnss_outlier_s = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(gnss_hz, "Hz", 0, 100, "position fixes per second and robot; 0: none");
    RADIOSLAM_FIELD(gnss_sigma_m, "m", 0.001, 1000, "standard deviation of a fix per axis, as it is stated");
    RADIOSLAM_FIELD(gnss_outlier_ratio, "", 0, 0.9,
                    "ratio of fixes with gross errors, which come in episodes");
    RADIOSLAM_FIELD(gnss_outlier_m, "m", 0, 1e5,
                    "standard deviation of the gross error per axis, constant over an episode");
    RADIOSLAM_FIELD(gnss_outlier_s, "s", 0.01, 1e5, "mean duration of an episode of gross errors");
  }
};

/// Fixes from time 0 to the motion's end; none at 0 Hz.
std::vector<PositionFix> simulate_gnss(const TrueMotion& motion, const GnssReceiverParams& params,
                                       const Rng& rng);

}  // namespace radioslam
