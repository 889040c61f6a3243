#include "radioslam/closure/sequence_pairs.hpp"

#include <cmath>

#include "radioslam/geometry/levenberg_marquardt.hpp"

namespace radioslam {
namespace {

constexpr LevenbergMarquardtLimits kPairFit{
    .max_steps = 30, .max_damping = 1e6, .settled = 1e-4};  // m and rad

/// Adds one pair. Its residual is radial to the circle of radius `peak_m` about q; a circle of radius 0 is a
/// point and constrains both directions.
void add_pair(PairCost& sum, const SE2& T, const Eigen::Matrix2d& turn, const PredictedPair& pair,
              double loss_sigmas) {
  const Eigen::Vector2d away = T * pair.p - pair.q;
  const double distance = away.norm(), off_m = distance - pair.peak_m;
  const double ratio = off_m / (pair.spread_m * loss_sigmas);
  const double weight = 1 / ((1 + ratio * ratio) * pair.spread_m * pair.spread_m);
  Eigen::Matrix<double, 2, 3> moved;  // derivative of T p by xi
  moved << turn, turn * Eigen::Vector2d(-pair.p.y(), pair.p.x());
  const Eigen::Vector2d u = distance > 0 ? Eigen::Vector2d(away / distance) : Eigen::Vector2d::Zero();
  const Eigen::Matrix2d held =
      pair.peak_m > 0 ? Eigen::Matrix2d(u * u.transpose()) : Eigen::Matrix2d::Identity();
  sum.cost += loss_sigmas * loss_sigmas * std::log1p(ratio * ratio);
  sum.gradient += weight * off_m * (moved.transpose() * u);
  sum.information += weight * (moved.transpose() * held * moved);
}

}  // namespace

std::vector<PredictedPair> predicted_pairs(const DistanceModel& model, const Eigen::MatrixXd& similarity,
                                           const SequenceWindow& i, const SequenceWindow& j) {
  std::vector<PredictedPair> pairs;
  for (Eigen::Index a = 0; a < similarity.rows(); ++a)
    for (Eigen::Index b = 0; b < similarity.cols(); ++b)
      if (const auto distance = model.predict(similarity(a, b)); distance && distance->spread_m > 0)
        pairs.push_back({i.position_m.col(a), j.position_m.col(b), distance->peak_m, distance->spread_m});
  return pairs;
}

PairCost evaluate_pairs(const SE2& T_j_i, const std::vector<PredictedPair>& pairs, double loss_sigmas) {
  PairCost sum;
  const Eigen::Matrix2d turn = T_j_i.rotation_matrix();
  for (const PredictedPair& pair : pairs) add_pair(sum, T_j_i, turn, pair, loss_sigmas);
  return sum;
}

PairFit fit_pairs(const SE2& start, const std::vector<PredictedPair>& pairs, double loss_sigmas) {
  const auto best = levenberg_marquardt(
      start, kPairFit, [&](const SE2& at) { return evaluate_pairs(at, pairs, loss_sigmas); },
      [](const SE2& at, const Eigen::Vector3d& move) { return at * SE2::exp(move); });
  return {best.at, best.objective};
}

}  // namespace radioslam
