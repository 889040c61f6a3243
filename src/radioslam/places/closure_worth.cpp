#include "radioslam/places/closure_worth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

template <class Pose>
class GreedyChoice {
 public:
  using Matrix = typename Pose::Jacobian;

  GreedyChoice(const std::vector<WeighedPair>& pairs, const PredictedPoses<Pose>& predicted,
               const Matrix& cov_closure, std::size_t count)
      : pairs_(pairs), predicted_(predicted), cov_closure_(cov_closure), is_chosen_(pairs.size(), false) {
    const std::vector<Pose>& poses = predicted.poses;
    for (const WeighedPair& pair : pairs) {
      by_i_.push_back(-(poses[pair.j.index()].inverse() * poses[pair.i.index()]).adjoint());
      remaining_.push_back(predicted.temperature * predicted.marginals.relative_pose(pair.i, pair.j));
      nodes_.push_back(pair.i);
      nodes_.push_back(pair.j);
    }
    for (std::size_t k = 0; k < pairs.size(); ++k) worth_.push_back(worth(k));
    explained_.setZero(kDof * static_cast<Eigen::Index>(pairs.size()),
                       kDof * static_cast<Eigen::Index>(count));
  }

  std::vector<std::size_t> choose(std::size_t count, double least_worth) {
    std::vector<std::size_t> chosen;
    while (chosen.size() < count) {
      const std::size_t best = most_worth();
      if (worth_[best] < least_worth) break;
      chosen.push_back(best);
      is_chosen_[best] = true;
      if (chosen.size() < count) learn(best, static_cast<Eigen::Index>(chosen.size()) - 1);
    }
    return chosen;
  }

 private:
  static constexpr Eigen::Index kDof = Pose::kDof;

  std::size_t most_worth() const {
    std::size_t best = pairs_.size();
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      if (!is_chosen_[k] && (best == pairs_.size() || worth_[k] > worth_[best])) best = k;
    return best;
  }

  double worth(std::size_t k) const {
    const auto log_det = [](const Matrix& matrix) {
      return 2 * Cholesky<Matrix>(matrix).factor().diagonal().array().log().sum();
    };
    const double gain = (log_det(remaining_[k] + cov_closure_) - log_det(cov_closure_)) / 2;
    return gain > 0 ? pairs_[k].weight * pairs_[k].probability * gain : 0;
  }

  /// Takes from the covariances of the others what the n-th choice, `best`, would explain.
  void learn(std::size_t best, Eigen::Index n) {
    const Cholesky<Matrix> cov_measured(remaining_[best] + cov_closure_);
    const Eigen::MatrixXd of_best = explained_rows(best).leftCols(kDof * n).transpose();
    const std::vector<Matrix> with_best = covariances_with(best);
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (pairs_[k].hypothesis != pairs_[best].hypothesis) continue;
      const Matrix with = with_best[k] - explained_rows(k).leftCols(kDof * n) * of_best;
      const Matrix explained = cov_measured.whitened_matrix(with.transpose()).transpose();
      explained_rows(k).template middleCols<kDof>(kDof * n) = explained;
      remaining_[k] -= explained * explained.transpose();
      worth_[k] = worth(k);
    }
  }

  auto explained_rows(std::size_t k) {
    return explained_.template middleRows<kDof>(kDof * static_cast<Eigen::Index>(k));
  }

  /// C_.k before any choice.
  std::vector<Matrix> covariances_with(std::size_t k) const {
    using Columns = typename Marginals<Pose>::PoseColumns;
    std::vector<Columns> coefficients(nodes_.size(), Columns::Zero(kDof, kDof));
    coefficients[2 * k] = by_i_[k].transpose();
    coefficients[2 * k + 1] = Matrix::Identity();
    const std::vector<Columns> with = predicted_.marginals.with_functions(nodes_, coefficients);
    std::vector<Matrix> result;
    for (std::size_t other = 0; other < pairs_.size(); ++other)
      result.push_back(predicted_.temperature * (by_i_[other] * with[2 * other] + with[2 * other + 1]));
    return result;
  }

  const std::vector<WeighedPair>& pairs_;
  const PredictedPoses<Pose>& predicted_;
  Matrix cov_closure_;
  std::vector<PoseId> nodes_;      ///< two of each pair
  std::vector<Matrix> by_i_;       ///< derivative of T_i_j by node i; by node j it is the identity
  std::vector<Matrix> remaining_;  ///< C_kk
  Eigen::MatrixXd explained_;      ///< C_kl = C_kl before any choice - explained_rows(k) explained_rows(l)^T
  std::vector<double> worth_;
  std::vector<bool> is_chosen_;
};

}  // namespace

template <class Pose>
std::vector<std::size_t> choose_by_worth(const std::vector<WeighedPair>& pairs,
                                         const PredictedPoses<Pose>& predicted,
                                         const typename Pose::Jacobian& cov_closure, std::size_t count,
                                         double least_worth) {
  count = std::min(count, pairs.size());
  return GreedyChoice<Pose>(pairs, predicted, cov_closure, count).choose(count, least_worth);
}

double probability_within(double radius_m, const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance) {
  constexpr int kSteps = 64;
  constexpr double kWidest = 5;         // standard deviations
  constexpr double kLeastSigma = 1e-6;  // of the radius
  const auto axes = symmetric_eigen<Eigen::Matrix2d>(covariance);
  const Eigen::Vector2d sigma = axes.values.cwiseMax(0).cwiseSqrt().cwiseMax(kLeastSigma * radius_m),
                        m = axes.vectors.transpose() * mean;
  const auto below = [](double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; };
  const double from = std::max(-radius_m, m.x() - kWidest * sigma.x());
  const double step = (std::min(radius_m, m.x() + kWidest * sigma.x()) - from) / kSteps;
  double sum = 0;
  for (int k = 0; k < kSteps && step > 0; ++k) {
    const double x = from + (k + 0.5) * step, z = (x - m.x()) / sigma.x();
    const double half = std::sqrt(std::max(0.0, radius_m * radius_m - x * x));
    sum += std::exp(-z * z / 2) * (below((half - m.y()) / sigma.y()) - below((-half - m.y()) / sigma.y()));
  }
  return std::clamp(sum * step / (sigma.x() * std::sqrt(2 * std::numbers::pi)), 0.0, 1.0);
}

#define RADIOSLAM_WORTH(Pose)                                                                           \
  template std::vector<std::size_t> choose_by_worth(const std::vector<WeighedPair>&,                    \
                                                    const PredictedPoses<Pose>&, const Pose::Jacobian&, \
                                                    std::size_t, double);
RADIOSLAM_WORTH(SE2)
RADIOSLAM_WORTH(SE3)
#undef RADIOSLAM_WORTH

}  // namespace radioslam
