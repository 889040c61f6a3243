// Pose graph: variables and factors of a joint estimate, independent of sensors.
// Perturbations are on the right: T <- T Exp(xi), xi = [translation, rotation]; points, drifts and biases
// add.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "radioslam/base/strong_id.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

using PoseId = StrongId<struct PoseIdTag>;
using PointId = StrongId<struct PointIdTag>;
using DriftId = StrongId<struct DriftIdTag>;
using BiasId = StrongId<struct BiasIdTag>;

/// How a relative pose's error E = Z^-1 T_i^-1 T_j becomes a vector.
enum class PoseChart {
  kLogarithm,  ///< Log(E)
  kG2o,        ///< g2o's: [t, angle] in the plane, [t, vector part of the quaternion with w >= 0] in space
};

/// A robust loss over the squared Mahalanobis norm s of a factor (Barron 2019 for the family).
/// rho(s) is what the factor adds to the cost: kNone gives s itself; all are s for small s.
enum class LossKind {
  kNone,
  kHuber,         ///< s up to c^2, 2 c sqrt(s) - c^2 beyond
  kCauchy,        ///< c^2 log(1 + s / c^2)
  kGemanMcClure,  ///< c^2 s / (c^2 + s)
};

struct Loss {
  LossKind kind = LossKind::kNone;
  double scale = 1;  ///< c, in standard deviations
};

/// Constant errors of one robot's odometry, as a variable: [yaw drift per metre (rad/m); relative error of
/// the path length].
using Drift = Eigen::Vector2d;

/// T_i_j was measured as `T_i_j` with `information` in the graph's chart.
/// With a drift, the prediction is compared after removing drift_jacobian * drift from the error:
/// residual = chart(Z^-1 T_i^-1 T_j) - drift_jacobian * drift.
template <class Pose>
struct RelativePoseFactor {
  PoseId i, j;
  Pose T_i_j;
  typename Pose::Jacobian information = Pose::Jacobian::Identity();
  Loss loss{};
  double weight = 1;  ///< scales the information; set by graduated losses and switches
  DriftId drift{};    ///< invalid: none
  Eigen::Matrix<double, Pose::kDof, 2> drift_jacobian = Eigen::Matrix<double, Pose::kDof, 2>::Zero();
};

/// An end of a distance: a pose (at its origin, or at a lever arm in its body frame) or a point.
template <class Pose>
struct RangeEnd {
  PoseId pose{};
  PointId point{};  ///< used when `pose` is invalid
  typename Pose::Point lever_arm = Pose::Point::Zero();
};

/// |p_j - p_i| / (1 - scale) + bias - range_m, with the scale error of `drift` and at most one of drift and
/// bias. At coinciding ends the direction is undefined and the Jacobian by the ends is zero.
template <class Pose>
struct RangeFactor {
  RangeEnd<Pose> i, j;
  double range_m = 0;
  double sigma_m = 1;
  Loss loss{};
  double weight = 1;
  BiasId bias{};              ///< of all ranges between two antennas, say; invalid: none
  DriftId drift{};            ///< of the odometry that `range_m` was learned from; invalid: true metres
  std::int64_t after_ns = 0;  ///< measured so long after the pose of end i, or of j if i is a point
};

/// The direction from pose i to a pose or point, as a unit vector in the receiver's frame, which is fixed to
/// i: residual (u - direction) / sigma, the chord, which is von Mises (Fisher) up to a constant. In space, an
/// azimuth alone is compared within the receiver's xy-plane: u is the unit vector of the projection.
template <class Pose>
struct BearingFactor {
  PoseId i;
  RangeEnd<Pose> j;
  typename Pose::Point direction = Pose::Point::UnitX();
  double sigma_rad = 1;
  Loss loss{};
  double weight = 1;
  bool azimuth_only = false;  ///< `direction` is in the receiver's xy-plane; no meaning in the plane
  Pose T_i_receiver{};
};

/// Where a pose or a point is, seen from pose i, in i's body frame: T_i^-1 p_j - position.
template <class Pose>
struct RelativePointFactor {
  PoseId i;
  RangeEnd<Pose> j;
  typename Pose::Point position = Pose::Point::Zero();
  Eigen::Matrix<double, Pose::kDim, Pose::kDim> information =
      Eigen::Matrix<double, Pose::kDim, Pose::kDim>::Identity();
  Loss loss{};
  double weight = 1;
};

/// p_i - position, of a pose or a point.
template <class Pose>
struct PositionFactor {
  RangeEnd<Pose> i;
  typename Pose::Point position = Pose::Point::Zero();
  Eigen::Matrix<double, Pose::kDim, Pose::kDim> information =
      Eigen::Matrix<double, Pose::kDim, Pose::kDim>::Identity();
  Loss loss{};
  double weight = 1;
};

/// chart(prior^-1 T_i). An information of rank below the full one is allowed (yaw only, ...).
/// In space, of gravity alone: [0; a x b] with the vertical in the body frame by the estimate, a, and by the
/// prior, b, which no heading and no position changes.
template <class Pose>
struct PosePriorFactor {
  PoseId i;
  Pose prior;
  typename Pose::Jacobian information = Pose::Jacobian::Identity();
  Loss loss{};
  double weight = 1;
  bool gravity_only = false;  ///< no meaning in the plane
};

/// drift - mean.
struct DriftPriorFactor {
  DriftId i;
  Drift mean = Drift::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
};

/// range_biases[i] - range_biases[of] - mean_m: a bias near a number, or near another bias, which may be one
/// that several have in common.
struct RangeBiasPriorFactor {
  BiasId i;
  BiasId of{};  ///< invalid: none
  double mean_m = 0;
  double sigma_m = 1;
};

/// A joint estimate's variables with their current values, and everything measured about them.
template <class Pose>
struct PoseGraph {
  using Point = typename Pose::Point;

  PoseChart chart = PoseChart::kLogarithm;
  std::vector<Pose> poses;
  std::vector<Point> points;
  std::vector<Drift> drifts;
  std::vector<double> range_biases;  ///< metres
  std::vector<bool> pose_fixed;  ///< empty, or one per pose; a graph without priors and fixed poses fixes the
                                 ///< first pose of every component

  std::vector<RelativePoseFactor<Pose>> relative_poses;
  std::vector<RangeFactor<Pose>> ranges;
  std::vector<BearingFactor<Pose>> bearings;
  std::vector<RelativePointFactor<Pose>> relative_points;
  std::vector<PositionFactor<Pose>> positions;
  std::vector<PosePriorFactor<Pose>> pose_priors;
  std::vector<DriftPriorFactor> drift_priors;
  std::vector<RangeBiasPriorFactor> range_bias_priors;
};

using PoseGraph2 = PoseGraph<SE2>;
using PoseGraph3 = PoseGraph<SE3>;

}  // namespace radioslam
