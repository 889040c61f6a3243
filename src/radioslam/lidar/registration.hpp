// Lays a cloud of surfels onto another: generalised ICP (Segal, Haehnel, Thrun 2009) with metric covariances.
//
//   e_k = q_k - T p_k               q_k: the target's surfel nearest to T p_k, within a reach
//   cost = sum rho_c(e_k' W_k e_k)  W_k = (C_q + R C_p R' + b^2 I)^-1,  rho_c: Geman, McClure
//
// Gauss-Newton on T Exp(xi), xi = [translation; rotation]. The blur b starts as wide as the start may be
// wrong, where points pull as points do, and narrows to nothing, where they slide along their surfaces.
// Neighbouring points err together (same surface, same scan line): the information counts `independent_share`
// of each.
// A point without a surface of its own is held to a surface of the other cloud that it lies close to, or
// the other way round; two points tell each other nothing, two in level lines their height (surfel.hpp).
// The normal of a surface is known to a few degrees only, so that some of what a wall tells across leaks
// along it: along a corridor, thousands of points promise what none of them knows. How far normals may lean
// is known (surfel.hpp: s^2; it also makes a match uncertain, by s^2 per squared distance along the surface),
// and with it what leaks of all information, l = sum w tr(W_k) s_k^2. So much, times `leak_factor`, is taken
// off along each axis a_i of what is told of the position, H_t = sum h_i a_i a_i', as if the position were
// known the less along it:
//   H' = K H,  K = I - sum (min(l, h_i) / h_i^2) H a_i a_i',  H' <= H in every direction.
// The points' own answer x = -H^-1 g then counts as much as H' says, against the prior (g' = K g): along a
// corridor the prior stands. (In space; a plane's scan line has its normals from many points.) Where only a
// turn and a shift together are unknown, in a round hall off its middle, a tenth of the turn's information
// stays that nothing tells.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/surfel.hpp"

namespace radioslam {

struct RegistrationParams {
  int max_iterations = 30;
  double loss_scale = 3;      ///< standard deviations beyond which a point counts for little
  double point_reach = 0.35;  ///< of the reach; farther from a surface a point without its own tells nothing
  double narrowing = 0.35;    ///< of the blur from one iteration to the next
  double leak_factor = 2;     ///< times what noisy normals leak
  double translation_tolerance_m = 1e-3;
  double rotation_tolerance_rad = 3e-4;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"max_iterations", "", 1, 1000, "steps of one registration"}, self.max_iterations);
    visit(Field{"loss_scale", "", 0.5, 100, "standard deviations beyond which a point counts for little"},
          self.loss_scale);
    visit(Field{"point_reach", "", 0, 1,
                "of the reach; farther from a surface a point without its own tells nothing"},
          self.point_reach);
    visit(Field{"narrowing", "", 0.01, 0.99, "of the blur from one step to the next"}, self.narrowing);
    visit(Field{"leak_factor", "", 0, 100, "times what noisy normals leak of their information elsewhere"},
          self.leak_factor);
    visit(Field{"translation_tolerance_m", "m", 1e-9, 1, "a step shorter than this is the last"},
          self.translation_tolerance_m);
    visit(Field{"rotation_tolerance_rad", "rad", 1e-9, 1, "and turning less than this"},
          self.rotation_tolerance_rad);
  }
};

enum class RegistrationEnd {
  kConverged,
  kMaxIterations,
  kNoOverlap,  ///< too few points met a surface, at the start or on the way: the pose is the start's
};

/// What is registered.
struct SurfelSource {
  std::vector<Surfel> surfels;
  double independent_share = 1;  ///< so much of each one's information counts
};

/// What is known of T_target_source beforehand: nothing where the information is zero.
struct PosePrior {
  SE3 pose;
  SE3::Jacobian information = SE3::Jacobian::Zero();  ///< of xi in pose * Exp(xi)
};

struct Registration {
  SE3 T_target_source;
  /// Of xi in T_target_source * Exp(xi) from the points alone, without the prior.
  SE3::Jacobian information = SE3::Jacobian::Zero();
  SE3::Jacobian posterior = SE3::Jacobian::Zero();  ///< with the prior
  double matched_share = 0;  ///< of the source's points with a surface within reach and the loss
  double rms_m = 0;          ///< of their distances across the surface... weighted
  int iterations = 0;
  RegistrationEnd end = RegistrationEnd::kNoOverlap;
};

/// The nearest surfel of the target closer than the root of the second argument, or none; thread-safe.
using NearestSurfel = std::function<const Surfel*(const Eigen::Vector3f& point, float squared_reach)>;

/// Where to start, and how wrong that may be.
struct RegistrationStart {
  SE3 T_target_source;
  double blur_m = 0;           ///< of the first iteration
  double reach_m = 1;          ///< no point farther from the target counts
  double least_met_share = 0;  ///< of the points; where fewer meet the target there is no overlap
};

/// The information of a scanner in the plane, with so much about height, and about roll and pitch, which it
/// does not tell.
SE3::Jacobian known_off_plane(SE3::Jacobian information, double height, double tilt);

Registration register_surfels(const NearestSurfel& target, const SurfelSource& source,
                              const RegistrationStart& start, const PosePrior& prior, ScannerKind kind,
                              const RegistrationParams& params);

}  // namespace radioslam
