// A layout refined by what was heard at it: every robot's rigid trajectory is moved, turned and scaled until
// the team's radio field (radio_field.hpp) and what is known besides agree best:
//
//   cost of the field + sum |moved|^2 / 2 sigma_layout^2 + sum ln(1 + (heading / 0.67 sigma_heading)^2)
//                     + sum (ln scale)^2 / 2 sigma_scale^2 + sum (ln kernel - ln usual)^2 / 2 sigma_kernel^2
//
// The prior on the layout is needed: walls make places look further apart than they are, so the field alone
// pushes rooms outwards.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/team_frame/radio_field.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

struct FieldParams {
  bool enabled = true;
  double exponent = 2.5;  ///< of the shifted RSS
  double channels = 5;    ///< m: access points count as so many independent ones
  double sigma_layout_m = 10;
  double sigma_scale = 0.1;
  double sigma_kernel = 1.5;  ///< of the logarithm of a parameter
  int max_nodes = 800;
  int iterations = 100;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"enabled", "", 0, 1, "refine teams laid out by fingerprints by their radio field"},
          self.enabled);
    visit(Field{"exponent", "", 0.5, 10, "power of the shifted RSS whose field is fitted"}, self.exponent);
    visit(Field{"channels", "", 1, 1000, "access points count as so many independent ones"}, self.channels);
    visit(Field{"sigma_layout_m", "m", 0.1, 1e4, "error of the layout before the field refines it"},
          self.sigma_layout_m);
    visit(Field{"sigma_scale", "", 0, 1, "error of an odometry's scale while the field is fitted"},
          self.sigma_scale);
    visit(Field{"sigma_kernel", "", 0.01, 10, "error of the logarithms of the field's parameters"},
          self.sigma_kernel);
    visit(
        Field{"max_nodes", "", 10, 5000, "more fingerprints than this are thinned; time grows with the cube"},
        self.max_nodes);
    visit(Field{"iterations", "", 1, 10000, "at most"}, self.iterations);
  }
};

/// Moves the free bodies. `field` holds a node per point of the bodies, body by body. Bodies without points
/// stay.
void refine_by_field(std::vector<RigidBody>& bodies, const RadioField& field, const FieldParams& params);

}  // namespace radioslam
