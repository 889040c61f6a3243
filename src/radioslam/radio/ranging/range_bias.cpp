#include "radioslam/radio/ranging/range_bias.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

using Eigen::Index;

constexpr double kBiasSettled_m = 1e-5;
constexpr double kClipSigmas = 3;  // keeps single reflections from dominating the correlation
constexpr double kMostCorrelated = 0.99;

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  return upper_median(std::move(values));
}

double deviation_around(std::vector<double> values, double centre) {
  for (double& value : values) value = std::abs(value - centre);
  return kMadToSigma * median_of(std::move(values));
}

/// The ranges of an epoch with the biases removed and the sigmas scaled to the estimated noise.
std::vector<RangeToAnchor> corrected(const RangeEpoch& epoch, const Eigen::VectorXd& biases,
                                     double noise_factor) {
  std::vector<RangeToAnchor> sights;
  for (const auto& range : epoch.ranges) {
    sights.push_back(range.sight);
    sights.back().range_m -= biases[static_cast<Index>(range.pair)];
    sights.back().sigma_m *= noise_factor;
  }
  return sights;
}

/// Adds the information of one epoch on the biases, with its position eliminated.
void add_epoch(const RangeEpoch& epoch, const std::vector<RangeToAnchor>& sights, const Multilateration& fix,
               const Eigen::MatrixXd& anchors, Eigen::MatrixXd& information, Eigen::VectorXd& pull) {
  const auto m = static_cast<Index>(sights.size());
  Eigen::MatrixXd j(m, anchors.rows());
  Eigen::VectorXd w(m), r(m);
  for (Index k = 0; k < m; ++k) {
    const auto& sight = sights[static_cast<std::size_t>(k)];
    const Eigen::VectorXd away = fix.position_m - anchors.col(static_cast<Index>(sight.anchor));
    j.row(k) = away.transpose() / std::max(away.norm(), 1e-9);
    w[k] = fix.weights[static_cast<std::size_t>(k)] / (sight.sigma_m * sight.sigma_m);
    r[k] = -fix.residuals_m[static_cast<std::size_t>(k)];  // measured minus predicted
  }
  const Eigen::MatrixXd wj = w.asDiagonal() * j;
  Eigen::MatrixXd p = -wj * fix.covariance * wj.transpose();
  p.diagonal() += w;
  const Eigen::VectorXd g = p * r;
  for (Index a = 0; a < m; ++a) {
    const auto pair_a = static_cast<Index>(epoch.ranges[static_cast<std::size_t>(a)].pair);
    pull[pair_a] += g[a];
    for (Index b = 0; b < m; ++b)
      information(pair_a, static_cast<Index>(epoch.ranges[static_cast<std::size_t>(b)].pair)) += p(a, b);
  }
}

/// Joint estimation of positions and biases by alternation.
class Calibration {
 public:
  Calibration(const Eigen::MatrixXd& anchors, const std::vector<RangeEpoch>& epochs, std::size_t pairs,
              const MultilaterationParams& multilateration, const RangeBiasParams& params)
      : anchors_(&anchors), epochs_(&epochs), multilateration_(multilateration), params_(params) {
    biases_ = Eigen::VectorXd::Zero(static_cast<Index>(pairs));
    information_ = Eigen::MatrixXd::Zero(biases_.size(), biases_.size());
  }

  CalibratedPositions run() {
    place();
    find_noise();
    place();
    for (int k = 0; k < params_.max_iterations && params_.prior_sigma_m > 0; ++k) {
      const double moved_m = improve_biases();
      find_noise();
      place();
      if (moved_m < kBiasSettled_m) break;
    }
    return result();
  }

 private:
  void place() {
    fixes_.clear();
    for (const auto& epoch : *epochs_)
      fixes_.push_back(multilaterate(*anchors_, corrected(epoch, biases_, noise_factor_), multilateration_));
  }

  /// Noise factor from the residuals' median deviation, corrected for the ranges used up by positions.
  void find_noise() {
    std::vector<double> normalised;
    double redundant = 0;
    for_each_fix([&](const RangeEpoch& epoch, const Multilateration& fix) {
      if (epoch.ranges.size() <= static_cast<std::size_t>(anchors_->rows())) return;
      redundant += static_cast<double>(epoch.ranges.size()) - static_cast<double>(anchors_->rows());
      for (std::size_t k = 0; k < epoch.ranges.size(); ++k)
        normalised.push_back(fix.residuals_m[k] / epoch.ranges[k].sight.sigma_m);
    });
    if (redundant == 0) return;
    const double redundancy_ratio = redundant / static_cast<double>(normalised.size());
    noise_factor_ = std::max(1.0, deviation_around(normalised, 0) / std::sqrt(redundancy_ratio));
  }

  /// Effective fraction of independent ranges, (1 - rho) / (1 + rho) for a first-order process with
  /// correlation rho of successive residuals: errors from reflections persist over time.
  double effective_sample_ratio() const {
    std::vector<double> last(static_cast<std::size_t>(biases_.size()), 0);
    double product = 0, square = 0;
    for_each_fix([&](const RangeEpoch& epoch, const Multilateration& fix) {
      for (std::size_t k = 0; k < epoch.ranges.size(); ++k) {
        const double sigma_m = noise_factor_ * epoch.ranges[k].sight.sigma_m;
        const double now = std::clamp(fix.residuals_m[k] / sigma_m, -kClipSigmas, kClipSigmas);
        product += now * std::exchange(last[epoch.ranges[k].pair], now);
        square += now * now;
      }
    });
    const double rho = square > 0 ? std::clamp(product / square, 0.0, kMostCorrelated) : 0;
    return (1 - rho) / (1 + rho);
  }

  /// One step of the biases; returns the largest change.
  double improve_biases() {
    const double prior = 1 / (params_.prior_sigma_m * params_.prior_sigma_m);
    information_.setZero();
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(biases_.size());
    for_each_fix([&](const RangeEpoch& epoch, const Multilateration& fix) {
      if (epoch.ranges.size() > static_cast<std::size_t>(anchors_->rows()))
        add_epoch(epoch, corrected(epoch, biases_, noise_factor_), fix, *anchors_, information_, pull);
    });
    const double ratio = effective_sample_ratio();
    information_ *= ratio, pull *= ratio;
    information_.diagonal().array() += prior;
    pull -= prior * biases_;
    const Eigen::VectorXd move = ldlt_solve(information_, pull);
    biases_ += move;
    return biases_.size() > 0 ? move.cwiseAbs().maxCoeff() : 0;
  }

  template <class Use>
  void for_each_fix(Use&& use) const {
    for (std::size_t k = 0; k < fixes_.size(); ++k)
      if (fixes_[k]) use((*epochs_)[k], *fixes_[k]);
  }

  CalibratedPositions result() const {
    CalibratedPositions result{fixes_, std::vector<RangeBias>(static_cast<std::size_t>(biases_.size())),
                               noise_factor_};
    std::vector<std::vector<double>> residuals(result.biases.size());
    for_each_fix([&](const RangeEpoch& epoch, const Multilateration& fix) {
      for (std::size_t k = 0; k < epoch.ranges.size(); ++k)
        residuals[epoch.ranges[k].pair].push_back(fix.residuals_m[k]);
    });
    const bool estimated = params_.prior_sigma_m > 0 && params_.max_iterations > 0;
    const Eigen::MatrixXd covariance = estimated ? inverse(information_) : information_;
    for (std::size_t k = 0; k < result.biases.size(); ++k) {
      const auto index = static_cast<Index>(k);
      result.biases[k] = {biases_[index], std::sqrt(covariance(index, index)),
                          deviation_around(residuals[k], 0), residuals[k].size()};
    }
    return result;
  }

  const Eigen::MatrixXd* anchors_;
  const std::vector<RangeEpoch>* epochs_;
  MultilaterationParams multilateration_;
  RangeBiasParams params_;
  Eigen::VectorXd biases_;
  Eigen::MatrixXd information_;
  double noise_factor_ = 1;
  std::vector<std::optional<Multilateration>> fixes_;
};

PositionFix fix_of(const RangeEpoch& epoch, const Multilateration& found) {
  PositionFix fix{epoch.stamp, Eigen::Vector3d::Zero(), found.sigma_m};
  fix.position_m.head(found.position_m.size()) = found.position_m;
  return fix;
}

double rms_of(const std::vector<std::optional<Multilateration>>& epochs) {
  double sum = 0, count = 0;
  for (const auto& epoch : epochs) {
    if (!epoch) continue;
    for (const double residual : epoch->residuals_m) sum += residual * residual, ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace

CalibratedPositions calibrate_positions(const Eigen::MatrixXd& anchors_m,
                                        const std::vector<RangeEpoch>& epochs, std::size_t pairs,
                                        const MultilaterationParams& multilateration,
                                        const RangeBiasParams& params) {
  return Calibration(anchors_m, epochs, pairs, multilateration, params).run();
}

ReceiverTrack track_receiver(const Eigen::MatrixXd& anchors_m, const std::vector<AnchorRange>& ranges,
                             std::size_t pairs, const ReceiverTrackParams& params) {
  const auto epochs = range_epochs(ranges, params.epochs);
  const auto found = calibrate_positions(anchors_m, epochs, pairs, params.position, params.bias);
  std::vector<PositionFix> fixes;
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    if (!found.epochs[k]) continue;
    const bool same_time = !fixes.empty() && fixes.back().stamp >= epochs[k].stamp;
    if (!same_time) fixes.push_back(fix_of(epochs[k], *found.epochs[k]));
  }
  return {moving_median(fixes, params.epochs), found.biases, epochs.size(), found.noise_factor,
          rms_of(found.epochs)};
}

}  // namespace radioslam
