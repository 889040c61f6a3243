// Parameters of `radioslam anchors`.
#pragma once

#include "radioslam/radio/ranging/anchor_layout.hpp"
#include "radioslam/radio/ranging/range_bias.hpp"

namespace radioslam::cli {

struct AnchorsParams {
  double distance_sigma_m = 0.01;
  AnchorLayoutParams layout;
  ReceiverTrackParams track;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        distance_sigma_m, "m", 1e-6, 100,
        "standard deviation of distances without sigma_m; the default suits a laser distance meter");
  }
  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("layout", self.layout);
    ReceiverTrackParams::visit_sections(self.track, visit);
  }
};

}  // namespace radioslam::cli
