#include "radioslam/closure/sequence_pairs.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace radioslam {
namespace {

constexpr int kMostFitSteps = 30;
constexpr double kSettled = 1e-4;  // metres and radians
constexpr double kFirstDamping = 1e-3, kMostDamping = 1e6, kDampingStep = 10;

/// Adds one pair. Its residual's direction is towards the circle of radius `peak_m` about q; a circle of
/// radius 0 is a point, and holds in both directions.
void add_pair(PairCost& sum, const SE2& T, const Eigen::Matrix2d& turn, const PredictedPair& pair,
              double loss_sigmas) {
  const Eigen::Vector2d away = T * pair.p - pair.q;
  const double distance = away.norm(), off_m = distance - pair.peak_m;
  const double share = off_m / (pair.spread_m * loss_sigmas);
  const double weight = 1 / ((1 + share * share) * pair.spread_m * pair.spread_m);
  Eigen::Matrix<double, 2, 3> moved;  // of T p by xi
  moved << turn, turn * Eigen::Vector2d(-pair.p.y(), pair.p.x());
  const Eigen::Vector2d u = distance > 0 ? Eigen::Vector2d(away / distance) : Eigen::Vector2d::Zero();
  const Eigen::Matrix2d held =
      pair.peak_m > 0 ? Eigen::Matrix2d(u * u.transpose()) : Eigen::Matrix2d::Identity();
  sum.cost += loss_sigmas * loss_sigmas * std::log1p(share * share);
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
        pairs.push_back({i.place_m.col(a), j.place_m.col(b), distance->peak_m, distance->spread_m});
  return pairs;
}

PairCost evaluate_pairs(const SE2& T_j_i, const std::vector<PredictedPair>& pairs, double loss_sigmas) {
  PairCost sum;
  const Eigen::Matrix2d turn = T_j_i.rotation_matrix();
  for (const PredictedPair& pair : pairs) add_pair(sum, T_j_i, turn, pair, loss_sigmas);
  return sum;
}

PairFit fit_pairs(const SE2& start, const std::vector<PredictedPair>& pairs, double loss_sigmas) {
  PairFit best{start, evaluate_pairs(start, pairs, loss_sigmas)};
  double damping = kFirstDamping;
  for (int step = 0; step < kMostFitSteps && damping < kMostDamping; ++step) {
    Eigen::Matrix3d damped = best.at.information;
    damped.diagonal() *= 1 + damping;
    const Eigen::Vector3d move = -damped.ldlt().solve(best.at.gradient);
    if (!move.allFinite()) break;
    const SE2 moved = best.T_j_i * SE2::exp(move);
    const PairCost at = evaluate_pairs(moved, pairs, loss_sigmas);
    const bool better = at.cost < best.at.cost;
    damping *= better ? 1 / kDampingStep : kDampingStep;
    if (!better) continue;
    best = {moved, at};
    if (move.norm() < kSettled) break;
  }
  return best;
}

}  // namespace radioslam
