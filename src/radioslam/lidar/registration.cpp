#include "radioslam/lidar/registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kPointsPerBlock = 256;  // sums of one block: the same for any number of threads
constexpr double kFewestMatches = 6;
constexpr double kPlanarInformation = 1e8;  // pins height, roll and pitch of a scanner in the plane

struct NormalSums {
  SE3::Jacobian hessian = SE3::Jacobian::Zero();
  SE3::Tangent gradient = SE3::Tangent::Zero();
  double leak = 0, weights = 0, weighted_squares = 0;
  std::size_t matches = 0;

  void operator+=(const NormalSums& other) {
    hessian += other.hessian;
    gradient += other.gradient;
    leak += other.leak;
    weights += other.weights;
    weighted_squares += other.weighted_squares;
    matches += other.matches;
  }
};

bool is_lone(const Surfel& surfel) { return surfel.shape < SurfelShape::kBlob; }

/// What two surfels tell of the offset from one to the other, in the source's frame.
struct Meeting {
  Eigen::Matrix3f covariance;
  float tilt_rad2;     ///< of the normal by which they are laid onto each other, about either axis
  float leaking_rad2;  ///< of that, by noise in what was measured
};

/// One pass over the source's points at one pose.
class Pass {
 public:
  Pass(const NearestSurfel& target, const SE3& T, double reach_m, double blur_m,
       const RegistrationParams& params)
      : target_(target),
        R_(T.rotation_matrix()),
        R_float_(R_.cast<float>()),
        t_float_(T.translation().cast<float>()),
        squared_reach_(static_cast<float>(reach_m * reach_m)),
        squared_blur_(static_cast<float>(blur_m * blur_m)),
        squared_point_reach_(squared_reach_ * static_cast<float>(params.point_reach * params.point_reach)),
        squared_scale_(params.loss_scale * params.loss_scale) {}

  /// Adds a point's share. With e' = R' e and W' = R' W R the error's Jacobian is [-I, [p]x].
  void add(const Surfel& surfel, NormalSums& sums) const {
    const Eigen::Vector3f moved = R_float_ * surfel.position + t_float_;
    const Surfel* met = target_(moved, squared_reach_);
    if (!met) return;
    const Eigen::Vector3f offset = met->position - moved;
    const float squared_distance = offset.squaredNorm();
    ++sums.matches;
    std::optional<Meeting> meeting = meeting_of(*met, surfel, squared_distance);
    if (!meeting) {
      ++sums.weights;
      return;
    }
    meeting->covariance.diagonal().array() += squared_blur_ + meeting->tilt_rad2 * squared_distance;
    const Eigen::Matrix3d information = meeting->covariance.cast<double>().inverse();
    const Eigen::Vector3d error = (R_float_.transpose() * offset).cast<double>();
    const Eigen::Vector3d pull = information * error;
    const double squares = error.dot(pull);
    const double root = squared_scale_ / (squared_scale_ + squares);
    const double weight = root * root;
    const Eigen::Matrix3d arm = skew(surfel.position.cast<double>());
    const Eigen::Matrix3d turned = information * arm;
    sums.hessian.topLeftCorner<3, 3>() += weight * information;
    sums.hessian.topRightCorner<3, 3>() -= weight * turned;
    sums.hessian.bottomRightCorner<3, 3>() -= weight * (arm * turned);
    sums.gradient.head<3>() -= weight * pull;
    sums.gradient.tail<3>() -= weight * (arm * pull);
    sums.leak += weight * information.trace() * static_cast<double>(meeting->leaking_rad2);
    sums.weights += weight;
    sums.weighted_squares += weight * squares;
  }

 private:
  /// A point that stands alone tells only where it meets a surface beyond doubt, about which it scatters as
  /// the surface's own points do, and close by: it may be another's. Two lines lie on one ground, which
  /// slopes between them; none of their normals is measured.
  std::optional<Meeting> meeting_of(const Surfel& met, const Surfel& surfel, float squared_distance) const {
    const bool met_alone = is_lone(met), alone = is_lone(surfel);
    if (met_alone && alone) {
      if (met.shape != SurfelShape::kLine || surfel.shape != SurfelShape::kLine) return std::nullopt;
      const float tilt_rad2 = std::max(met.tilt_rad2, surfel.tilt_rad2);
      return Meeting{turned_back(met.covariance) + surfel.covariance, tilt_rad2, 0};
    }
    if (met_alone || alone) {
      const Surfel& surface = alone ? met : surfel;
      if (surface.shape != SurfelShape::kSurface || squared_distance >= squared_point_reach_)
        return std::nullopt;
      const Eigen::Matrix3f covariance = 2 * (alone ? turned_back(met.covariance) : surfel.covariance);
      return Meeting{covariance, surface.tilt_rad2, surface.tilt_rad2};
    }
    const float tilt_rad2 = 0.25F * (met.tilt_rad2 + surfel.tilt_rad2);
    return Meeting{turned_back(met.covariance) + surfel.covariance, tilt_rad2, tilt_rad2};
  }
  Eigen::Matrix3f turned_back(const Eigen::Matrix3f& covariance) const {
    return R_float_.transpose() * covariance * R_float_;
  }

  const NearestSurfel& target_;
  Eigen::Matrix3d R_;
  Eigen::Matrix3f R_float_;
  Eigen::Vector3f t_float_;
  float squared_reach_, squared_blur_, squared_point_reach_;
  double squared_scale_;
};

NormalSums sum_over(const std::vector<Surfel>& source, const Pass& pass) {
  const std::size_t blocks = (source.size() + kPointsPerBlock - 1) / kPointsPerBlock;
  std::vector<NormalSums> partial(blocks);
  parallel_for(blocks, 2, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t k = b * kPointsPerBlock; k < std::min(source.size(), (b + 1) * kPointsPerBlock); ++k)
        pass.add(source[k], partial[b]);
  });
  NormalSums total;
  for (const NormalSums& sums : partial) total += sums;
  total.hessian.bottomLeftCorner<3, 3>() = total.hessian.topRightCorner<3, 3>().transpose();
  return total;
}

/// A scanner in the plane says nothing of height, roll and pitch: they stay as they are.
void pin_plane(Registration& result, SE3::Tangent& gradient) {
  for (SE3::Jacobian* information : {&result.information, &result.posterior})
    *information = known_off_plane(*information, kPlanarInformation, kPlanarInformation);
  gradient.segment<3>(2).setZero();
}

/// K of registration.hpp: times an information, what of it is told by the points rather than by normals that
/// lean; times a gradient, that of the same answer.
SE3::Jacobian kept_without_leak(const SE3::Jacobian& information, double leak) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information.topLeftCorner<3, 3>());
  const Eigen::Array3d h = axes.eigenvalues().array().max(1e-12);
  const Eigen::Vector3d off = h.min(leak) / h.square();
  SE3::Jacobian keep = SE3::Jacobian::Identity();
  keep.leftCols<3>() -=
      information.leftCols<3>() * axes.eigenvectors() * off.asDiagonal() * axes.eigenvectors().transpose();
  return keep;
}

}  // namespace

SE3::Jacobian known_off_plane(SE3::Jacobian information, double height, double tilt) {
  information.middleRows<3>(2).setZero();
  information.middleCols<3>(2).setZero();
  information.diagonal().segment<3>(2) << height, tilt, tilt;
  return information;
}

Registration register_surfels(const NearestSurfel& target, const SurfelSource& source,
                              const RegistrationStart& start, const PosePrior& prior, ScannerKind kind,
                              const RegistrationParams& params) {
  constexpr double kNoBlur_m = 0.01;
  Registration result;
  result.T_target_source = start.T_target_source;
  double blur_m = start.blur_m;
  const double fewest =
      std::max(kFewestMatches, start.least_met_share * static_cast<double>(source.surfels.size()));
  for (result.iterations = 1; result.iterations <= params.max_iterations; ++result.iterations) {
    const NormalSums sums =
        sum_over(source.surfels, Pass(target, result.T_target_source, start.reach_m, blur_m, params));
    if (static_cast<double>(sums.matches) < fewest) return {.T_target_source = start.T_target_source};
    const SE3::Tangent from_prior = (prior.pose.inverse() * result.T_target_source).log();
    SE3::Tangent gradient = source.independent_share * sums.gradient;
    result.information = source.independent_share * sums.hessian;
    if (kind == ScannerKind::kSpatial) {
      const SE3::Jacobian keep =
          kept_without_leak(result.information, params.leak_factor * source.independent_share * sums.leak);
      result.information = keep * result.information;
      gradient = keep * gradient;
    }
    gradient += prior.information * from_prior;
    result.posterior = result.information + prior.information;
    if (kind == ScannerKind::kPlanar) pin_plane(result, gradient);
    SE3::Jacobian hessian = result.posterior;
    hessian.diagonal() *= 1 + 1e-9;
    SE3::Tangent step = -hessian.ldlt().solve(gradient);
    step *= std::min(1.0, start.reach_m / std::max(step.head<3>().norm(), 1e-9));
    result.T_target_source = result.T_target_source * SE3::exp(step);
    result.matched_share = sums.weights / static_cast<double>(source.surfels.size());
    result.rms_m = std::sqrt(sums.weighted_squares / std::max(1e-12, 3 * sums.weights));
    const bool is_short = step.head<3>().norm() < params.translation_tolerance_m &&
                          step.tail<3>().norm() < params.rotation_tolerance_rad;
    if (is_short && blur_m == 0) {
      result.end = RegistrationEnd::kConverged;
      return result;
    }
    blur_m = blur_m * params.narrowing < kNoBlur_m ? 0 : blur_m * params.narrowing;
  }
  result.end = RegistrationEnd::kMaxIterations;
  return result;
}

}  // namespace radioslam
