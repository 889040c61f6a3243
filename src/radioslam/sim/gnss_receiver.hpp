// A receiver of satellite positions at the body's origin: noise, and spells of gross errors.
//
//   fix = position + n + e,   n ~ N(0, gnss_sigma_m^2) per axis and fix
//
// e is zero but in spells, where reflections off houses stand for the direct signals: then it is one draw of
// N(0, gnss_gross_m^2) per axis as long as the spell lasts. Spells come and go as a chain of two states, on
// average gnss_gross_s long and gnss_gross_share of all fixes. The stated sigma is that of n. Fixes are told
// in the truth's frame.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/mission/radio_links.hpp"
#include "radioslam/sim/true_motion.hpp"

namespace radioslam {

struct GnssReceiverParams {
  double gnss_hz = 0;
  double gnss_sigma_m = 1.5;
  double gnss_gross_share = 0.15;
  double gnss_gross_m = 30;
  double gnss_gross_s = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"gnss_hz", "Hz", 0, 100, "position fixes of each robot per second; 0: none"}, self.gnss_hz);
    visit(Field{"gnss_sigma_m", "m", 0.001, 1000, "their white noise per axis, which they state"},
          self.gnss_sigma_m);
    visit(Field{"gnss_gross_share", "", 0, 0.9, "share of fixes in spells of gross errors"},
          self.gnss_gross_share);
    visit(Field{"gnss_gross_m", "m", 0, 1e5, "standard deviation of such a spell's error per axis"},
          self.gnss_gross_m);
    visit(Field{"gnss_gross_s", "s", 0.01, 1e5, "mean length of a spell"}, self.gnss_gross_s);
  }
};

/// Fixes from time 0 to the motion's end; none at 0 Hz.
std::vector<PositionFix> simulate_gnss(const TrueMotion& motion, const GnssReceiverParams& params,
                                       const Rng& rng);

}  // namespace radioslam
