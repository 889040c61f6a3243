// Refines a layout of rigid trajectories with the team's radio field (radio_field.hpp): every robot's
// trajectory is translated, rotated and scaled to minimise
//
//   cost of the field + sum |moved|^2 / 2 sigma_layout^2 + sum ln(1 + (heading / 0.67 sigma_heading)^2)
//                     + sum (ln scale)^2 / 2 sigma_scale^2 + sum (ln kernel - ln nominal)^2 / 2
//                     sigma_kernel^2
//
// where moved is the displacement from the layout and heading the deviation from the common heading. The
// prior on the layout is needed: walls make fingerprints less similar than their distance alone would, so the
// field alone pushes rooms outwards.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/team_frame/radio_field.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

struct FieldParams {
  bool enabled = true;
  double exponent = 2.5;
  double channels = 5;
  double sigma_layout_m = 10;
  double sigma_scale = 0.1;
  double sigma_kernel = 1.5;
  int max_nodes = 800;
  int iterations = 100;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(enabled, "", 0, 1,
                          "refinement of fingerprint layouts by the radio field (0: off, 1: on)");
    RADIOSLAM_FIELD(exponent, "", 0.5, 10,
                    "power applied to the shifted RSS before the radio field is fitted");
    RADIOSLAM_FIELD(
        channels, "", 1, 1000,
        "effective number of independent access points; higher values weight the radio field more");
    RADIOSLAM_FIELD(sigma_layout_m, "m", 0.1, 1e4,
                    "standard deviation of the layout's positions before the radio field refines them");
    RADIOSLAM_FIELD(sigma_scale, "", 0, 1,
                    "standard deviation of the odometry's scale error in the radio field fit");
    RADIOSLAM_FIELD(sigma_kernel, "", 0.01, 10,
                    "prior standard deviation of the logarithms of the radio field's kernel parameters");
    RADIOSLAM_FIELD(max_nodes, "", 10, 5000,
                    "largest number of fingerprints in the radio field fit; more are thinned evenly (time "
                    "grows with the cube)");
    RADIOSLAM_FIELD(iterations, "", 1, 10000, "largest number of L-BFGS iterations of the radio field fit");
  }
};

/// Moves the free bodies that have points. `field` holds one node per point, body by body.
void refine_by_field(std::vector<RigidBody>& bodies, const RadioField& field, const FieldParams& params);

}  // namespace radioslam
