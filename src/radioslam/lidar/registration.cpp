#include "radioslam/lidar/registration.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kMinCorrespondences = 6;
constexpr double kPlanarInformation = 1e8;  // fixes height, roll and pitch for a planar scanner

struct PoseEquations {
  SE3::Jacobian information;
  SE3::Tangent gradient;
};

/// K of registration.hpp, which removes the information from normal noise; applied to the gradient as well it
/// keeps the points' own solution.
SE3::Jacobian noise_discount(const SE3::Jacobian& information, double normal_noise_information) {
  const auto axes = symmetric_eigen<Eigen::Matrix3d>(information.topLeftCorner<3, 3>());
  const Eigen::Array3d h = axes.values.array().max(1e-12);
  const Eigen::Vector3d off = h.min(normal_noise_information) / h.square();
  SE3::Jacobian keep = SE3::Jacobian::Identity();
  keep.leftCols<3>() -=
      information.leftCols<3>() * axes.vectors * off.asDiagonal() * axes.vectors.transpose();
  return keep;
}

/// The points' equations, each point counting `effective_sample_ratio`, without what noisy normals pretend.
PoseEquations discount_normal_noise(const LinearisedPoints& points, double effective_sample_ratio,
                                    ScannerKind kind, const RegistrationParams& params) {
  PoseEquations result{effective_sample_ratio * points.hessian, effective_sample_ratio * points.gradient};
  if (kind == ScannerKind::kPlanar) return result;
  const SE3::Jacobian keep =
      noise_discount(result.information,
                     params.normal_noise_factor * effective_sample_ratio * points.normal_noise_information);
  return {keep * result.information, keep * result.gradient};
}

PoseEquations with_prior(PoseEquations equations, const PosePrior& prior, const SE3& T) {
  const SE3::Tangent from_prior = (prior.pose.inverse() * T).log();
  equations.gradient += prior.information * from_prior;
  equations.information += prior.information;
  return equations;
}

/// Keeps height, roll and pitch, which a planar scanner does not observe.
PoseEquations fixed_out_of_plane(PoseEquations equations, ScannerKind kind) {
  if (kind == ScannerKind::kSpatial) return equations;
  equations.information = with_planar_prior(equations.information, kPlanarInformation, kPlanarInformation);
  equations.gradient.segment<3>(2).setZero();
  return equations;
}

SE3::Tangent solve(const PoseEquations& equations) {
  SE3::Jacobian hessian = equations.information;
  hessian.diagonal() *= 1 + 1e-9;
  return -ldlt_solve(hessian, equations.gradient);
}

SE3::Tangent bounded(const SE3::Tangent& step, double max_distance_m) {
  return step * std::min(1.0, max_distance_m / std::max(step.head<3>().norm(), 1e-9));
}

bool is_small(const SE3::Tangent& step, const RegistrationParams& params) {
  return step.head<3>().norm() < params.translation_tolerance_m &&
         step.tail<3>().norm() < params.rotation_tolerance_rad;
}

double next_kernel_width(double kernel_width_m, double kernel_decay) {
  constexpr double kNoKernel_m = 0.01;
  return kernel_width_m * kernel_decay < kNoKernel_m ? 0 : kernel_width_m * kernel_decay;
}

}  // namespace

SE3::Jacobian with_planar_prior(SE3::Jacobian information, double height, double tilt) {
  information.middleRows<3>(2).setZero();
  information.middleCols<3>(2).setZero();
  information.diagonal().segment<3>(2) << height, tilt, tilt;
  return information;
}

Registration register_surfels(const NearestSurfel& target, const SurfelSource& source,
                              const RegistrationStart& start, const PosePrior& prior, ScannerKind kind,
                              const RegistrationParams& params) {
  const auto source_size = static_cast<double>(source.surfels.size());
  const double min_correspondences =
      std::max(kMinCorrespondences, start.min_correspondence_ratio * source_size);
  double kernel_width_m = start.kernel_width_m;
  Registration result{.T_target_source = start.T_target_source};
  SE3& T = result.T_target_source;
  for (result.iterations = 1; result.iterations <= params.max_iterations; ++result.iterations) {
    const LinearisedPoints points = linearise_correspondences(
        target, source.surfels, T,
        {start.max_distance_m, params.point_distance_ratio, kernel_width_m, params.loss_scale});
    if (static_cast<double>(points.matches) < min_correspondences)
      return {.T_target_source = start.T_target_source};
    const PoseEquations trusted = discount_normal_noise(points, source.effective_sample_ratio, kind, params);
    const PoseEquations posterior = fixed_out_of_plane(with_prior(trusted, prior, T), kind);
    const SE3::Tangent step = bounded(solve(posterior), start.max_distance_m);
    T = T * SE3::exp(step);
    result.information = fixed_out_of_plane(trusted, kind).information;
    result.posterior = posterior.information;
    result.inlier_ratio = points.weights / source_size;
    result.normalised_rms = std::sqrt(points.weighted_squares / std::max(1e-12, 3 * points.weights));
    if (is_small(step, params) && kernel_width_m == 0) {
      result.end = RegistrationStatus::kConverged;
      return result;
    }
    kernel_width_m = next_kernel_width(kernel_width_m, params.kernel_decay);
  }
  result.end = RegistrationStatus::kMaxIterations;
  return result;
}

}  // namespace radioslam
