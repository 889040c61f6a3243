// Optima agree with those of Ceres, with independently written, automatically differentiated residuals.
// Parameters: [t, angle] in the plane, [t, rotation vector] in space, points and drifts as they are.
#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include "graph/random_graphs.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

template <int N>
using Array = Eigen::Matrix<double, N, 1>;
template <class T, int N>
using Vec = Eigen::Matrix<T, N, 1>;

/// L^T with information = L L^T: whitens a residual.
template <class Matrix>
Matrix root(const Matrix& information, double weight) {
  return Matrix(Eigen::LLT<Matrix>(weight * information).matrixU());
}

/// World-from-body and back for parameters of a pose.
template <class T>
Vec<T, 2> turn(const Vec<T, 1>& r, const Vec<T, 2>& p, double sign) {
  const T c = cos(r[0]), s = T(sign) * sin(r[0]);
  return {c * p[0] - s * p[1], s * p[0] + c * p[1]};
}
template <class T>
Vec<T, 3> turn(const Vec<T, 3>& r, const Vec<T, 3>& p, double sign) {
  const Vec<T, 3> signed_r = T(sign) * r;
  Vec<T, 3> out;
  ceres::AngleAxisRotatePoint(signed_r.data(), p.data(), out.data());
  return out;
}

/// g2o's rotation error of Z^-1 T_i^-1 T_j.
template <class T>
Vec<T, 1> rotation_error(const Vec<T, 1>& z, const Vec<T, 1>& i, const Vec<T, 1>& j) {
  const T e = j[0] - i[0] - z[0];
  return Vec<T, 1>(atan2(sin(e), cos(e)));
}
template <class T>
Vec<T, 3> rotation_error(const Vec<T, 3>& z, const Vec<T, 3>& i, const Vec<T, 3>& j) {
  T qz[4], qi[4], qj[4], zi[4], e[4];
  const Vec<T, 3> minus_z = -z, minus_i = -i;
  ceres::AngleAxisToQuaternion(minus_z.data(), qz);
  ceres::AngleAxisToQuaternion(minus_i.data(), qi);
  ceres::AngleAxisToQuaternion(j.data(), qj);
  ceres::QuaternionProduct(qz, qi, zi);
  ceres::QuaternionProduct(zi, qj, e);
  const T sign(e[0] < T(0) ? -1.0 : 1.0);
  return {sign * e[1], sign * e[2], sign * e[3]};
}

Array<3> parameters(const SE2& pose) {
  return {pose.translation().x(), pose.translation().y(), pose.angle()};
}
Array<6> parameters(const SE3& pose) {
  Array<6> p;
  p.head<3>() = pose.translation();
  const auto& q = pose.rotation();
  const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  ceres::QuaternionToAngleAxis(wxyz, p.data() + 3);
  return p;
}

template <class Pose>
struct Relative {
  static constexpr int kDim = Pose::kDim, kDof = Pose::kDof;
  template <class T>
  bool operator()(const T* a, const T* b, const T* drift, T* out) const {
    const Eigen::Map<const Vec<T, kDof>> i(a), j(b);
    const Vec<T, kDof> z = measured.template cast<T>();
    constexpr int kR = kDof - kDim;
    const Vec<T, kR> ri = i.template tail<kR>(), rj = j.template tail<kR>(), rz = z.template tail<kR>();
    const Vec<T, kDim> way = j.template head<kDim>() - i.template head<kDim>();
    const Vec<T, kDim> rest = turn<T>(ri, way, -1) - z.template head<kDim>();
    Vec<T, kDof> e;
    e.template head<kDim>() = turn<T>(rz, rest, -1);
    e.template tail<kR>() = rotation_error<T>(rz, ri, rj);
    e -= by_drift.template cast<T>() * Eigen::Map<const Vec<T, 2>>(drift);
    Eigen::Map<Vec<T, kDof>>{out} = whiten.template cast<T>() * e;
    return true;
  }
  Array<kDof> measured;
  typename Pose::Jacobian whiten;
  Eigen::Matrix<double, kDof, 2> by_drift;
};

template <class Pose, class T>
Vec<T, Pose::kDim> end_position(const T* pose, const T* point, const RangeEnd<Pose>& end) {
  constexpr int kDim = Pose::kDim, kR = Pose::kDof - kDim;
  if (!end.pose.valid()) return Eigen::Map<const Vec<T, kDim>>(point);
  const Eigen::Map<const Vec<T, Pose::kDof>> p(pose);
  return p.template head<kDim>() +
         turn<T>(Vec<T, kR>(p.template tail<kR>()), Vec<T, kDim>(end.lever_arm.template cast<T>()), 1);
}

/// Two pose blocks and a point block; the one that an end does not use is a dummy.
template <class Pose>
struct Range {
  template <class T>
  bool operator()(const T* a, const T* b, const T* point, const T* bias, const T* drift, T* out) const {
    const Vec<T, Pose::kDim> way = end_position<Pose>(b, point, f.j) - end_position<Pose>(a, point, f.i);
    out[0] = (way.norm() / (T(1) - drift[1]) + bias[0] - T(f.range_m)) * T(std::sqrt(f.weight) / f.sigma_m);
    return true;
  }
  RangeFactor<Pose> f;
};

template <class Pose>
struct Bearing {
  template <class T>
  bool operator()(const T* a, const T* b, const T* point, T* out) const {
    constexpr int kDim = Pose::kDim, kR = Pose::kDof - kDim;
    const Eigen::Map<const Vec<T, Pose::kDof>> i(a);
    const Vec<T, kDim> way = end_position<Pose>(b, point, f.j) - i.template head<kDim>();
    const Vec<T, kDim> by_body = turn<T>(Vec<T, kR>(i.template tail<kR>()), way, -1);
    const auto turn_back = f.T_i_receiver.rotation_matrix().transpose().eval();
    const Vec<T, kDim> seen =
        turn_back.template cast<T>() * (by_body - f.T_i_receiver.translation().template cast<T>());
    Eigen::Map<Vec<T, kDim>>{out} =
        (seen / seen.norm() - f.direction.template cast<T>()) * T(std::sqrt(f.weight) / f.sigma_rad);
    return true;
  }
  BearingFactor<Pose> f;
};

template <class Pose>
struct Position {
  template <class T>
  bool operator()(const T* a, const T* point, T* out) const {
    const Vec<T, Pose::kDim> e = end_position<Pose>(a, point, f.i) - f.position.template cast<T>();
    Eigen::Map<Vec<T, Pose::kDim>>{out} = root(f.information, f.weight).template cast<T>() * e;
    return true;
  }
  PositionFactor<Pose> f;
};

template <class Pose>
struct RelativePoint {
  template <class T>
  bool operator()(const T* a, const T* b, const T* point, T* out) const {
    constexpr int kDim = Pose::kDim, kR = Pose::kDof - kDim;
    const Eigen::Map<const Vec<T, Pose::kDof>> i(a);
    const Vec<T, kDim> way = end_position<Pose>(b, point, f.j) - i.template head<kDim>();
    const Vec<T, kDim> seen = turn<T>(Vec<T, kR>(i.template tail<kR>()), way, -1);
    Eigen::Map<Vec<T, kDim>>{out} =
        root(f.information, f.weight).template cast<T>() * (seen - f.position.template cast<T>());
    return true;
  }
  RelativePointFactor<Pose> f;
};

struct BiasPrior {
  template <class T>
  bool operator()(const T* bias, const T* of, T* out) const {
    out[0] = (bias[0] - of[0] - T(f.mean_m)) / T(f.sigma_m);
    return true;
  }
  RangeBiasPriorFactor f;
};

struct DriftPrior {
  template <class T>
  bool operator()(const T* d, T* out) const {
    const Vec<T, 2> e = Eigen::Map<const Vec<T, 2>>(d) - f.mean.cast<T>();
    Eigen::Map<Vec<T, 2>>{out} = root(f.information, 1).cast<T>() * e;
    return true;
  }
  DriftPriorFactor f;
};

ceres::LossFunction* ceres_loss(const Loss& loss) {
  if (loss.kind == LossKind::kHuber) return new ceres::HuberLoss(loss.scale);
  return loss.kind == LossKind::kCauchy ? new ceres::CauchyLoss(loss.scale) : nullptr;
}

/// A graph as a Ceres problem. Block `poses.size()` is the identity, held, for priors and unused ends.
template <class Pose>
class Referee {
 public:
  static constexpr int kDim = Pose::kDim, kDof = Pose::kDof;

  explicit Referee(const PoseGraph<Pose>& graph)
      : points_(graph.points), drifts_(graph.drifts), biases_(graph.range_biases) {
    for (const auto& pose : graph.poses) poses_.push_back(parameters(pose));
    poses_.push_back(Array<kDof>::Zero());
    points_.push_back(Pose::Point::Zero());
    drifts_.push_back(Drift::Zero());
    biases_.push_back(0);
    for (const auto& f : graph.relative_poses) {
      auto* cost = new ceres::AutoDiffCostFunction<Relative<Pose>, kDof, kDof, kDof, 2>(
          new Relative<Pose>{parameters(f.T_i_j), root(f.information, f.weight), f.drift_jacobian});
      problem_.AddResidualBlock(cost, ceres_loss(f.loss), pose(f.i), pose(f.j), drift(f.drift));
    }
    for (const auto& f : graph.pose_priors) {
      auto* cost = new ceres::AutoDiffCostFunction<Relative<Pose>, kDof, kDof, kDof, 2>(new Relative<Pose>{
          parameters(f.prior), root(f.information, f.weight), Eigen::Matrix<double, kDof, 2>::Zero()});
      problem_.AddResidualBlock(cost, ceres_loss(f.loss), pose({}), pose(f.i), drift({}));
    }
    for (const auto& f : graph.ranges)
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<Range<Pose>, 1, kDof, kDof, kDim, 1, 2>(new Range<Pose>{f}),
          ceres_loss(f.loss), pose(f.i.pose), pose(f.j.pose), point(f.j.point), bias(f.bias), drift(f.drift));
    for (const auto& f : graph.bearings)
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<Bearing<Pose>, kDim, kDof, kDof, kDim>(new Bearing<Pose>{f}),
          ceres_loss(f.loss), pose(f.i), pose(f.j.pose), point(f.j.point));
    for (const auto& f : graph.relative_points)
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<RelativePoint<Pose>, kDim, kDof, kDof, kDim>(
                                    new RelativePoint<Pose>{f}),
                                ceres_loss(f.loss), pose(f.i), pose(f.j.pose), point(f.j.point));
    for (const auto& f : graph.positions)
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<Position<Pose>, kDim, kDof, kDim>(new Position<Pose>{f}),
          ceres_loss(f.loss), pose(f.i.pose), point(f.i.point));
    for (const auto& f : graph.drift_priors)
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<DriftPrior, 2, 2>(new DriftPrior{f}), nullptr,
                                drift(f.i));
    for (const auto& f : graph.range_bias_priors)
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<BiasPrior, 1, 1, 1>(new BiasPrior{f}),
                                nullptr, bias(f.i), bias(f.of));
    for (double* dummy :
         {poses_.back().data(), points_.back().data(), drifts_.back().data(), &biases_.back()})
      if (problem_.HasParameterBlock(dummy)) problem_.SetParameterBlockConstant(dummy);
  }

  void hold(PoseId i) { problem_.SetParameterBlockConstant(pose(i)); }

  /// The optimum's cost without Ceres' factor of one half.
  double solve() {
    ceres::Solver::Options options;
    options.max_num_iterations = 500;
    options.function_tolerance = options.parameter_tolerance = options.gradient_tolerance = 1e-14;
    options.initial_trust_region_radius = 1e12;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return 2 * summary.final_cost;
  }
  double cost() {
    double cost = 0;
    problem_.Evaluate({}, &cost, nullptr, nullptr, nullptr);
    return 2 * cost;
  }
  double max_difference(const PoseGraph<Pose>& graph) const {
    double worst = 0;
    for (std::size_t i = 0; i < graph.poses.size(); ++i)
      worst = std::max(worst, (graph.poses[i].translation() - poses_[i].template head<kDim>()).norm());
    for (std::size_t i = 0; i < graph.points.size(); ++i)
      worst = std::max(worst, (graph.points[i] - points_[i]).norm());
    for (std::size_t i = 0; i < graph.drifts.size(); ++i)
      worst = std::max(worst, (graph.drifts[i] - drifts_[i]).norm());
    for (std::size_t i = 0; i < graph.range_biases.size(); ++i)
      worst = std::max(worst, std::abs(graph.range_biases[i] - biases_[i]));
    return worst;
  }

 private:
  double* pose(PoseId i) { return (i.valid() ? poses_[i.index()] : poses_.back()).data(); }
  double* point(PointId i) { return (i.valid() ? points_[i.index()] : points_.back()).data(); }
  double* drift(DriftId i) { return (i.valid() ? drifts_[i.index()] : drifts_.back()).data(); }
  double* bias(BiasId i) { return i.valid() ? &biases_[i.index()] : &biases_.back(); }

  std::vector<Array<kDof>> poses_;
  std::vector<typename Pose::Point> points_;
  std::vector<Drift> drifts_;
  std::vector<double> biases_;
  ceres::Problem problem_;
};

template <class Pose>
class CeresReferee : public testing::Test {};
TYPED_TEST_SUITE(CeresReferee, test::PoseTypes);

template <class Pose>
PoseGraph<Pose> mixed_graph(std::uint64_t seed) {
  auto graph = test::draw_graph<Pose>(seed, 20, 1, test::Extras::kAll);
  graph.chart = PoseChart::kG2o;
  for (std::size_t k = 0; k < graph.ranges.size(); k += 2) graph.ranges[k].loss = {LossKind::kCauchy, 0.8};
  for (std::size_t k = 0; k < graph.bearings.size(); k += 2) graph.bearings[k].loss = {LossKind::kHuber, 0.8};
  for (std::size_t k = 0; k < graph.ranges.size(); k += 5) graph.ranges[k].weight = 0.3;
  return graph;
}

TYPED_TEST(CeresReferee, SameCostAwayFromTheOptimum) {
  auto graph = mixed_graph<TypeParam>(1);
  test::disturb(graph, 1, 0.2);
  EXPECT_NEAR(Referee<TypeParam>(graph).cost(), total_cost(graph), 1e-9 * total_cost(graph));
}

TYPED_TEST(CeresReferee, SameOptimumWithEveryKindOfFactorAndRobustLosses) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto graph = mixed_graph<TypeParam>(seed);
    test::disturb(graph, seed, 0.05);
    Referee<TypeParam> referee(graph);
    const auto summary = optimize(graph, {});
    const double expected = referee.solve();
    EXPECT_NEAR(summary.final_cost, expected, 1e-7 * expected);
    EXPECT_LT(referee.max_difference(graph), 1e-3);
  }
}

TYPED_TEST(CeresReferee, SameOptimumOfRelativePosesWithTheFirstHeld) {
  auto graph = test::draw_graph<TypeParam>(4, 40, 2, test::Extras::kNone);
  graph.chart = PoseChart::kG2o;
  Referee<TypeParam> referee(graph);
  referee.hold(PoseId(0));
  const auto summary = optimize(graph, {});
  const double expected = referee.solve();
  EXPECT_NEAR(summary.final_cost, expected, 1e-7 * expected);
  EXPECT_LT(referee.max_difference(graph), 1e-4);
}

}  // namespace
}  // namespace radioslam
