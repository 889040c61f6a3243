#include "radioslam/lidar/registration.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kPointsPerBlock = 256;

bool has_no_normal(const Surfel& surfel) { return surfel.shape < SurfelShape::kUnstructured; }

int sector_of(const Eigen::Vector3f& position) {
  constexpr float kPi = std::numbers::pi_v<float>;
  constexpr int kAround = kSectors / 2;
  const float turn = (std::atan2(position.y(), position.x()) + kPi) / (2 * kPi);
  const int sector = std::clamp(static_cast<int>(turn * kAround), 0, kAround - 1);
  return position.z() > 0 ? sector + kAround : sector;
}

/// Uncertainty of the offset between two surfels, in the source's frame.
struct Correspondence {
  Eigen::Matrix3f covariance;
  float tilt_rad2;          ///< variance of the normal of the pair about either axis
  float normal_noise_rad2;  ///< part of it that measurement noise causes
};

/// The terms of single points at one pose.
class PointLinearisation {
 public:
  PointLinearisation(const NearestSurfel& target, const SE3& T, const CorrespondenceSearch& search)
      : target_(target),
        R_(T.rotation_matrix().cast<float>()),
        t_(T.translation().cast<float>()),
        squared_max_distance_(static_cast<float>(search.max_distance_m * search.max_distance_m)),
        squared_kernel_width_(static_cast<float>(search.kernel_width_m * search.kernel_width_m)),
        squared_point_distance_(squared_max_distance_ * static_cast<float>(search.point_distance_ratio *
                                                                           search.point_distance_ratio)),
        squared_scale_(search.loss_scale * search.loss_scale) {}

  /// Adds one point's terms. With e' = R' e and W' = R' W R the error's Jacobian is [-I, [p]x].
  void add(const Surfel& surfel, LinearisedPoints& sums) const {
    const Eigen::Vector3f moved = R_ * surfel.position + t_;
    const Surfel* nearest = target_(moved, squared_max_distance_);
    if (!nearest) return;
    const Eigen::Vector3f offset = nearest->position - moved;
    const float squared_distance = offset.squaredNorm();
    ++sums.matches;
    std::optional<Correspondence> correspondence = correspond(*nearest, surfel, squared_distance);
    if (!correspondence) {
      ++sums.weights;
      return;
    }
    correspondence->covariance.diagonal().array() +=
        squared_kernel_width_ + correspondence->tilt_rad2 * squared_distance;
    const Eigen::Matrix3d information = correspondence->covariance.cast<double>().inverse();
    const Eigen::Vector3d error = (R_.transpose() * offset).cast<double>();
    const Eigen::Vector3d pull = information * error;
    const double squares = error.dot(pull);
    const double root = squared_scale_ / (squared_scale_ + squares);
    const double weight = root * root;
    const Eigen::Matrix3d arm = skew(surfel.position.cast<double>());
    const Eigen::Matrix3d turned = information * arm;
    sums.hessian.topLeftCorner<3, 3>() += weight * information;
    sums.hessian.topRightCorner<3, 3>() -= weight * turned;
    sums.hessian.bottomRightCorner<3, 3>() -= weight * (arm * turned);
    SE3::Tangent gradient;
    gradient << -weight * pull, -weight * (arm * pull);
    sums.gradient += gradient;
    sums.sectors.col(sector_of(surfel.position)) += gradient;
    sums.normal_noise_information +=
        weight * information.trace() * static_cast<double>(correspondence->normal_noise_rad2);
    sums.weights += weight;
    sums.weighted_squares += weight * squares;
  }

 private:
  /// A point without a normal is matched only to a certainly planar surfel and only close by, since it may
  /// belong to another surface; it scatters about it as the surface's own points do. Two scan lines are on
  /// the same ground, which slopes between them; neither normal is measured.
  std::optional<Correspondence> correspond(const Surfel& target, const Surfel& surfel,
                                           float squared_distance) const {
    const bool matched_isolated = has_no_normal(target), alone = has_no_normal(surfel);
    if (matched_isolated && alone) {
      if (target.shape != SurfelShape::kScanLine || surfel.shape != SurfelShape::kScanLine)
        return std::nullopt;
      const float tilt_rad2 = std::max(target.tilt_rad2, surfel.tilt_rad2);
      return Correspondence{rotated_into_source(target.covariance) + surfel.covariance, tilt_rad2, 0};
    }
    if (matched_isolated || alone) {
      const Surfel& surface = alone ? target : surfel;
      if (surface.shape != SurfelShape::kSurface || squared_distance >= squared_point_distance_)
        return std::nullopt;
      const Eigen::Matrix3f covariance =
          2 * (alone ? rotated_into_source(target.covariance) : surfel.covariance);
      return Correspondence{covariance, surface.tilt_rad2, surface.tilt_rad2};
    }
    const float tilt_rad2 = 0.25F * (target.tilt_rad2 + surfel.tilt_rad2);
    return Correspondence{rotated_into_source(target.covariance) + surfel.covariance, tilt_rad2, tilt_rad2};
  }

  Eigen::Matrix3f rotated_into_source(const Eigen::Matrix3f& covariance) const {
    return R_.transpose() * covariance * R_;
  }

  const NearestSurfel& target_;
  Eigen::Matrix3f R_;
  Eigen::Vector3f t_;
  float squared_max_distance_, squared_kernel_width_, squared_point_distance_;
  double squared_scale_;
};

constexpr double kMinCorrespondences = 6;
constexpr double kModelled = 0.05;          // of the points' variances: errors that residuals do not show
constexpr double kPlanarInformation = 1e8;  // fixes height, roll and pitch for a planar scanner

struct PoseEquations {
  SE3::Jacobian information;
  SE3::Tangent gradient;
  SE3::Jacobian noise;  ///< covariance of the gradient
};

/// Covariance of the points' gradient by how its parts scatter from sector to sector; six degrees of freedom
/// are spent on the pose.
SE3::Jacobian sector_noise(const LinearisedPoints& points, double effective_sample_ratio) {
  constexpr double kFree = static_cast<double>(kSectors) / (kSectors - SE3::kDof);
  const SE3::Jacobian scatter = points.sectors * points.sectors.transpose();
  return effective_sample_ratio * (effective_sample_ratio * kFree * scatter + kModelled * points.hessian);
}

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
  PoseEquations result{effective_sample_ratio * points.hessian, effective_sample_ratio * points.gradient,
                       sector_noise(points, effective_sample_ratio)};
  if (kind == ScannerKind::kPlanar) return result;
  const SE3::Jacobian keep =
      noise_discount(result.information,
                     params.normal_noise_factor * effective_sample_ratio * points.normal_noise_information);
  return {keep * result.information, keep * result.gradient, congruence(keep, result.noise)};
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
  equations.noise = with_planar_prior(equations.noise, kPlanarInformation, kPlanarInformation);
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

void LinearisedPoints::operator+=(const LinearisedPoints& other) {
  hessian += other.hessian;
  gradient += other.gradient;
  sectors += other.sectors;
  normal_noise_information += other.normal_noise_information;
  weights += other.weights;
  weighted_squares += other.weighted_squares;
  matches += other.matches;
}

LinearisedPoints linearise_correspondences(const NearestSurfel& target, const std::vector<Surfel>& source,
                                           const SE3& T, const CorrespondenceSearch& search) {
  const PointLinearisation points(target, T, search);
  const std::size_t blocks = (source.size() + kPointsPerBlock - 1) / kPointsPerBlock;
  std::vector<LinearisedPoints> partial(blocks);
  parallel_for(blocks, 2, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t k = b * kPointsPerBlock; k < std::min(source.size(), (b + 1) * kPointsPerBlock); ++k)
        points.add(source[k], partial[b]);
  });
  LinearisedPoints total;
  for (const LinearisedPoints& sums : partial) total += sums;
  total.hessian.bottomLeftCorner<3, 3>() = total.hessian.topRightCorner<3, 3>().transpose();
  return total;
}

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
    result.noise = fixed_out_of_plane(trusted, kind).noise;
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
