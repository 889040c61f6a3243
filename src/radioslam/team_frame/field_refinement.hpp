// Refines a layout of rigid trajectories with the team's radio field (radio_field.hpp): every robot's
// trajectory is translated, rotated and scaled to minimise
//
//   cost of the field + sum |moved|^2 / 2 sigma_layout^2 + sum ln(1 + (heading / 0.67 sigma_heading)^2)
//                     + sum (ln scale)^2 / 2 sigma_scale^2 + sum (ln kernel - ln nominal)^2 / 2
//                     sigma_kernel^2
//                     + sum (ln a - ln nominal)^2 / 2
//
// where moved is the displacement from the layout, heading the deviation from the common heading and a the
// robot's loss. Walls make fingerprints less similar than their distance alone would, so the field pushes
// rooms outwards: the size of the whole is that of the layout, which comes from the odometry.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/team_frame/radio_field.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

// Minimises a smooth function by limited-memory BFGS (Nocedal 1980; Liu and Nocedal 1989) with a backtracking
// line search (Armijo condition); pairs of negative curvature are dropped.

struct ValueAndGradient {
  double value = 0;
  Eigen::VectorXd gradient;
};

using SmoothFunction = std::function<ValueAndGradient(const Eigen::VectorXd& x)>;

struct Minimum {
  Eigen::VectorXd x;
  double value = 0;
  int iterations = 0;
};

/// Stops after `max_iterations` or when an iteration lowers the value by less than `min_gain`. Variables
/// should be scaled to similar magnitude. A value that is not finite counts as infinitely high.
Minimum minimise_lbfgs(const SmoothFunction& function, const Eigen::VectorXd& start, int max_iterations,
                       double min_gain);

struct FieldParams {
  bool enabled = true;
  double exponent = 2.5;
  double channels = 5;
  double sigma_layout_m = 10;
  double sigma_scale = 0.1;
  double sigma_kernel = 1.5;
  int iterations = 25;
  int rounds = 4;

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
    RADIOSLAM_FIELD(iterations, "", 1, 10000,
                    "largest number of L-BFGS iterations in a round of the radio field fit");
    RADIOSLAM_FIELD(rounds, "", 1, 1000,
                    "rounds of the radio field fit; each also moves robots that fit better elsewhere");
  }
};

/// The team's fingerprints as a field: a node per point of the bodies, body by body.
struct TeamField {
  RadioField field;
  Eigen::MatrixXd similarity;  ///< nodes x nodes; only its order counts
};

/// A layout and the field fitted to it.
struct FieldFit {
  std::vector<RigidBody> bodies;
  FieldModel model;
  double cost = 0;  ///< of the field alone
};

/// Moves the free bodies that have points, and fits the model.
void refine_by_field(FieldFit& fit, const RadioField& field, const FieldParams& params);

/// Translates each free body to where its fingerprints fit the field of the others best: of its present place
/// and those that take one of its fingerprints to one of the most similar fingerprints of other bodies.
/// Returns the indices of the bodies that moved.
std::vector<std::size_t> relocate_by_field(FieldFit& fit, const TeamField& team);

/// Another round: relocation (not in the first, which has no fitted field yet), then refinement.
void advance_by_field(FieldFit& fit, const TeamField& team, const FieldParams& params, bool is_first);

}  // namespace radioslam
