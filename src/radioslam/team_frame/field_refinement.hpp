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

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/team_frame/radio_field.hpp"
#include "radioslam/team_frame/rigid_layout.hpp"

namespace radioslam {

// Finds and corrects robots that a fingerprint layout placed far from where similar fingerprints were
// measured.
//
// Fingerprints with few access points have low similarity to all others, which a distance-based layout
// interprets as large distances, although their most similar fingerprints are mostly right. An outlier is a
// robot whose fingerprints are further from their most similar ones of three other robots than is typical for
// the team; it is translated, without rotation, to where its fingerprints agree best with their most similar
// ones.

/// Moves the outliers among the free bodies, the worst first, and returns their indices. `similarity`: nodes
/// x nodes of the bodies' points; only its order counts, and zero means nothing in common. Outliers exceed
/// the team's median distance by three robust standard deviations (1.48 median absolute deviations).
std::vector<std::size_t> relocate_outliers(std::vector<RigidBody>& bodies, const Eigen::MatrixXd& similarity);

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
