#include "radioslam/closure/sequence_match.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "radioslam/geometry/alignment.hpp"
#include "radioslam/geometry/levenberg_marquardt.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

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

namespace {

using Eigen::Index;

constexpr Index kMinPlaces = 3;
constexpr int kHeadings = 4;
constexpr double kHopelessRatio = 1.5;  // multiple of max_residual_m beyond which no estimate recovers

/// Similarities, with a row per node of i and a column per node of j.
Eigen::MatrixXd window_similarities(const RadioMeasurements& radio, const SequenceWindow& i,
                                    const SequenceWindow& j) {
  Eigen::MatrixXd table(i.position_m.cols(), j.position_m.cols());
  for (Index a = 0; a < table.rows(); ++a)
    for (Index b = 0; b < table.cols(); ++b)
      table(a, b) =
          similarity_of(radio, i.nodes[static_cast<std::size_t>(a)], j.nodes[static_cast<std::size_t>(b)]);
  return table;
}

/// Positions and their matches in the other window, by column.
struct Matches {
  Eigen::Matrix2Xd source, target;
};

/// Similarity-weighted mean of the k most similar `places`; nothing if none is similar.
std::optional<Eigen::Vector2d> matched_place(const Eigen::VectorXd& similarity,
                                             const Eigen::Matrix2Xd& places, int nearest) {
  std::vector<Index> order(static_cast<std::size_t>(similarity.size()));
  std::iota(order.begin(), order.end(), Index{0});
  const auto k = std::min<std::ptrdiff_t>(nearest, similarity.size());
  std::partial_sort(order.begin(), order.begin() + k, order.end(), [&](Index a, Index b) {
    return similarity[a] != similarity[b] ? similarity[a] > similarity[b] : a < b;
  });
  double sum = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  for (auto n = order.begin(); n != order.begin() + k; ++n) {
    sum += similarity[*n];
    place += similarity[*n] * places.col(*n);
  }
  if (sum <= 0) return std::nullopt;
  return Eigen::Vector2d(place / sum);
}

Matches match_positions(const Eigen::MatrixXd& similarity, const Eigen::Matrix2Xd& from,
                        const Eigen::Matrix2Xd& to, int nearest) {
  Matches matches{Eigen::Matrix2Xd(2, from.cols()), Eigen::Matrix2Xd(2, from.cols())};
  Index count = 0;
  for (Index a = 0; a < from.cols(); ++a) {
    const auto place = matched_place(similarity.row(a).transpose(), to, nearest);
    if (!place) continue;
    matches.source.col(count) = from.col(a);
    matches.target.col(count++) = *place;
  }
  matches.source.conservativeResize(2, count);
  matches.target.conservativeResize(2, count);
  return matches;
}

/// T_j_i from the matches of both directions.
SE2 aligned(const Matches& i_in_j, const Matches& j_in_i) {
  const Index n = i_in_j.source.cols(), m = j_in_i.source.cols();
  Eigen::Matrix2Xd source(2, n + m), target(2, n + m);
  source << i_in_j.source, j_in_i.target;
  target << i_in_j.target, j_in_i.source;
  return align_points(source, target);
}

double mean_distance_m(const SE2& T, const Matches& matches) {
  double sum = 0;
  for (Index a = 0; a < matches.source.cols(); ++a)
    sum += (T * Eigen::Vector2d(matches.source.col(a)) - matches.target.col(a)).norm();
  return sum / static_cast<double>(matches.source.cols());
}

/// `points` reflected about the long axis of `about`.
Eigen::Matrix2Xd reflected(const Eigen::Matrix2Xd& points, const Eigen::Matrix2Xd& about) {
  const Eigen::Vector2d mean = about.rowwise().mean();
  const Eigen::Matrix2Xd spread = about.colwise() - mean;
  const auto axes = symmetric_eigen<Eigen::Matrix2d>(spread * spread.transpose());
  const Eigen::Vector2d across = axes.vectors.col(0);
  const Eigen::Matrix2d mirror = Eigen::Matrix2d::Identity() - 2 * across * across.transpose();
  return (mirror * (points.colwise() - mean)).colwise() + mean;
}

std::vector<SE2> candidate_starts(const SE2& T, const SequenceWindow& i, const SequenceWindow& j) {
  const Eigen::Matrix2Xd moved = (T.rotation_matrix() * i.position_m).colwise() + T.translation();
  std::vector<SE2> starts{align_points(i.position_m, reflected(moved, j.position_m)),
                          align_points(i.position_m, reflected(moved, moved))};
  const SE2 to_middle(i.position_m.rowwise().mean(), 0);
  for (int quarter = 1; quarter < kHeadings; ++quarter)
    starts.push_back(T * to_middle *
                     SE2(Eigen::Vector2d::Zero(), quarter * 2 * std::numbers::pi / kHeadings) *
                     to_middle.inverse());
  return starts;
}

bool is_other(const SE2& a, const SE2& b, const SequenceMatchParams& params) {
  const SE2 gap = a.inverse() * b;
  return gap.translation().norm() > params.alternative_distance_m ||
         std::abs(gap.angle()) > params.alternative_angle_rad;
}

/// Whether a different pose costs hardly more. The cost, a sum over all pairs, is scaled by the ratio of
/// independent pairs, as the covariance is.
bool has_alternative(const PairFit& fit, const std::vector<PredictedPair>& pairs, const SequenceWindow& i,
                     const SequenceWindow& j, const SequenceMatchParams& params) {
  for (const SE2& start : candidate_starts(fit.T_j_i, i, j)) {
    const PairFit other = fit_pairs(start, pairs, params.loss_sigmas);
    const double margin = params.effective_sample_ratio * (other.at.cost - fit.at.cost);
    if (is_other(fit.T_j_i, other.T_j_i, params) && margin < params.min_alternative_margin) return true;
  }
  return false;
}

std::optional<Eigen::Matrix3d> inverse_if_regular(const Eigen::Matrix3d& information) {
  const Cholesky<Eigen::Matrix3d> cholesky(information);
  if (!cholesky.succeeded()) return std::nullopt;
  const Eigen::Matrix3d inverse = cholesky.inverse();
  return inverse.allFinite() ? std::optional(inverse) : std::nullopt;
}

}  // namespace

SequenceFit match_windows(const RadioMeasurements& radio, const SequenceWindow& i, const SequenceWindow& j,
                          const SequenceMatchParams& params) {
  const Eigen::MatrixXd similarity = window_similarities(radio, i, j);
  const Matches i_in_j = match_positions(similarity, i.position_m, j.position_m, params.nearest);
  const Matches j_in_i = match_positions(similarity.transpose(), j.position_m, i.position_m, params.nearest);
  if (std::min(i_in_j.source.cols(), j_in_i.source.cols()) < kMinPlaces)
    return {SequenceStatus::kTooFewMatches, 0, {}};
  const SE2 start = aligned(i_in_j, j_in_i);
  const double start_residual_m = mean_distance_m(start, i_in_j);
  if (start_residual_m >= kHopelessRatio * params.max_residual_m)
    return {SequenceStatus::kResidual, start_residual_m, start};
  const auto pairs = predicted_pairs(radio.near_model, similarity, i, j);
  if (pairs.empty()) return {SequenceStatus::kNoDistances, start_residual_m, start};
  const PairFit best = fit_pairs(start, pairs, params.loss_sigmas);
  SequenceFit fit{SequenceStatus::kAccepted, mean_distance_m(best.T_j_i, i_in_j), best.T_j_i};
  if (fit.residual_m >= params.max_residual_m)
    fit.status = SequenceStatus::kResidual;
  else if (has_alternative(best, pairs, i, j, params))
    fit.status = SequenceStatus::kAmbiguous;
  else if (const auto covariance = inverse_if_regular(params.effective_sample_ratio * best.at.information))
    fit.covariance = *covariance;
  else
    fit.status = SequenceStatus::kUncertain;
  return fit;
}

}  // namespace radioslam
