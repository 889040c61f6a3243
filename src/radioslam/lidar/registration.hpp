// Scan matching: generalised ICP (Segal, Haehnel, Thrun 2009) of surfels to a map, with metric covariances.
//
//   e_k = q_k - T p_k               q_k: the target's surfel nearest to T p_k, within max_distance_m
//   cost = sum rho_c(e_k' W_k e_k)  W_k = (C_q + R C_p R' + b^2 I)^-1,  rho_c: Geman, McClure
//
// Gauss-Newton on T Exp(xi), xi = [translation; rotation]. The kernel width b starts at the uncertainty of
// the initial pose, where correspondences act as point to point, and shrinks to zero, where they act as plane
// to plane. Errors of neighbouring points are correlated: each counts `effective_sample_ratio`. A point
// without a normal is only matched to a nearby planar surfel of the other cloud; two scan-line points
// constrain their height, two isolated points nothing (surfel.hpp).
//
// Normals are known to a variance s^2 about either axis (surfel.hpp). It adds s^2 times the squared distance
// to a correspondence's covariance, and it leaks information into directions that the surfaces do not
// constrain, such as along a corridor: l = normal_noise_factor sum w tr(W_k) s_k^2. For spatial scanners this
// is discounted along each axis a_i of the position information H_t = sum h_i a_i a_i',
//   H' = K H,  K = I - sum (min(l, h_i) / h_i^2) H a_i a_i',  H' <= H in every direction,
// and g' = K g, so that the solution -H^-1 g of the points is weighted by H' against the prior. Where only a
// combination of rotation and shift is unobservable (a round hall, off its centre), a tenth of the rotation's
// spurious information remains.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

// Correspondences of a scan's surfels at one pose, and the sums of their Gauss-Newton normal equations.
//
//   e_k = q_k - T p_k                q_k: the target's surfel nearest to T p_k, within max_distance_m
//   W_k = (C_q + R C_p R' + b^2 I)^-1, with the variance of the normals times the squared distance in C
//   H = sum w J' W J,  g = sum w J' W e,  w = rho_c'    c: loss_scale, Geman, McClure;  b: kernel_width_m
//
// Both are found in one pass over the points, block by block: the sums do not depend on the number of
// threads.

/// The target's nearest surfel closer than the root of the second argument, or null; thread-safe.
using NearestSurfel = std::function<const Surfel*(const Eigen::Vector3f& point, float squared_max_distance)>;

struct CorrespondenceSearch {
  double max_distance_m = 1;
  double point_distance_ratio = 1;  ///< max. distance of points without a normal, over that of others
  double kernel_width_m = 0;
  double loss_scale = 3;
};

/// Of the source's view: 24 of azimuth, below and above its horizon.
inline constexpr int kSectors = 48;

struct LinearisedPoints {
  SE3::Jacobian hessian = SE3::Jacobian::Zero();
  SE3::Tangent gradient = SE3::Tangent::Zero();
  Eigen::Matrix<double, 6, kSectors> sectors = Eigen::Matrix<double, 6, kSectors>::Zero();  ///< g by sector
  double normal_noise_information = 0;  ///< sum of w tr(W) s^2, s^2: variance of noisy normals
  double weights = 0, weighted_squares = 0;
  std::size_t matches = 0;  ///< points with a correspondence

  void operator+=(const LinearisedPoints& other);
};

/// About xi in T Exp(xi).
LinearisedPoints linearise_correspondences(const NearestSurfel& target, const std::vector<Surfel>& source,
                                           const SE3& T, const CorrespondenceSearch& search);

struct RegistrationParams {
  int max_iterations = 30;
  double loss_scale = 3;
  double point_distance_ratio = 0.35;
  double kernel_decay = 0.35;
  double normal_noise_factor = 2;
  double translation_tolerance_m = 1e-3;
  double rotation_tolerance_rad = 3e-4;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(max_iterations, "", 1, 1000, "largest number of iterations of one registration");
    RADIOSLAM_FIELD(loss_scale, "", 0.5, 100,
                    "residual, in standard deviations, beyond which a correspondence is down-weighted");
    RADIOSLAM_FIELD(
        point_distance_ratio, "", 0, 1,
        "largest distance of a point without a normal from its surface, as a fraction of that of others");
    RADIOSLAM_FIELD(kernel_decay, "", 0.01, 0.99,
                    "factor by which the correspondence kernel narrows per iteration");
    RADIOSLAM_FIELD(normal_noise_factor, "", 0, 100,
                    "factor on the information from noisy normals that is discounted; higher values trust "
                    "the prior more");
    RADIOSLAM_FIELD(translation_tolerance_m, "m", 1e-9, 1,
                    "translation step below which the registration has converged");
    RADIOSLAM_FIELD(rotation_tolerance_rad, "rad", 1e-9, 1,
                    "rotation step below which the registration has converged");
  }
};

enum class RegistrationStatus {
  kConverged,
  kMaxIterations,
  kNoOverlap,  ///< too few correspondences in some iteration: the pose is the initial one
};

/// The surfels to register.
struct SurfelSource {
  std::vector<Surfel> surfels;
  double effective_sample_ratio = 1;  ///< factor on the information of each, for correlated errors
};

/// Prior on T_target_source; zero information: none.
struct PosePrior {
  SE3 pose;
  SE3::Jacobian information = SE3::Jacobian::Zero();  ///< about xi in pose * Exp(xi)
};

struct Registration {
  SE3 T_target_source;
  /// About xi in T_target_source * Exp(xi), without the prior.
  SE3::Jacobian information = SE3::Jacobian::Zero();
  SE3::Jacobian posterior = SE3::Jacobian::Zero();  ///< with the prior
  SE3::Jacobian noise = SE3::Jacobian::Zero();      ///< of the points' gradient, by their residuals
  double inlier_ratio = 0;    ///< robust weights of the correspondences, over all source points
  double normalised_rms = 0;  ///< weighted rms of the normalised residuals, per axis
  int iterations = 0;
  RegistrationStatus end = RegistrationStatus::kNoOverlap;
};

/// The initial pose, and how correspondences are searched from it.
struct RegistrationStart {
  SE3 T_target_source;
  double kernel_width_m = 0;            ///< in the first iteration
  double max_distance_m = 1;            ///< largest correspondence distance
  double min_correspondence_ratio = 0;  ///< kNoOverlap if fewer source points have a correspondence
};

/// Replaces the information about what a planar scanner does not observe: `height`, and `tilt` for roll and
/// pitch.
SE3::Jacobian with_planar_prior(SE3::Jacobian information, double height, double tilt);

Registration register_surfels(const NearestSurfel& target, const SurfelSource& source,
                              const RegistrationStart& start, const PosePrior& prior, ScannerKind kind,
                              const RegistrationParams& params);

}  // namespace radioslam
