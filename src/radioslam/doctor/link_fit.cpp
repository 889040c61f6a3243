#include "radioslam/doctor/link_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/doctor/link_samples.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

using Alignment = LinkLikelihood::Alignment;
using Motion = LinkLikelihood::Motion;
constexpr std::size_t kStartLinks = 4;
constexpr int kStartYaws = 18;
constexpr std::size_t kRefined = 6;
constexpr int kIterations = 12;
constexpr double kExplainedSigmas = 3;
constexpr double kDifference = 1e-4;  // of numerical derivatives, metres or radians

/// An alignment and those next to it along each of its coordinates.
struct Neighbourhood {
  explicit Neighbourhood(const Alignment& T) : centre(T) {
    for (int k = 0; k < T.size(); ++k) moved.emplace_back(Alignment(T + kDifference * Alignment::Unit(k)));
  }
  Motion centre;
  std::vector<Motion> moved;
};

/// The alignment of greatest likelihood.
class AlignmentSearch {
 public:
  explicit AlignmentSearch(const LinkLikelihood& model) : model_(model) {}

  Alignment sought() const {
    std::pair<double, Alignment> best{-std::numeric_limits<double>::infinity(), Alignment::Zero()};
    for (const auto& [cost, T] : starts()) {
      for (const Alignment& candidate : {refined(T), T}) {
        const double value = model_.log_likelihood(candidate);
        if (value > best.first) best = {value, candidate};
      }
    }
    return best.second;
  }

 private:
  Alignment start(const LinkSample& sample, double yaw, double azimuth_in_i, double range_m) const {
    const Eigen::Vector3d to(range_m * std::cos(azimuth_in_i), range_m * std::sin(azimuth_in_i), 0);
    const double c = std::cos(yaw), s = std::sin(yaw);
    const Eigen::Vector3d& p = sample.p_j;
    const Eigen::Vector3d moved(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
    const Eigen::Vector3d t = sample.p_i + to - moved;
    return {t.x(), t.y(), model_.is_planar() ? 0 : t.z(), yaw};
  }

  /// Directions from i to j in i's frame that a link allows.
  std::vector<double> directions(const LinkSample& sample, double yaw) const {
    std::vector<double> result;
    if (!sample.is_angle) {
      for (int k = 0; k < 12; ++k) result.push_back(k * std::numbers::pi / 6);
      return result;
    }
    const Eigen::Matrix3d& R = sample.R_receiver;
    for (const double azimuth_rad : sample.azimuths_rad) {
      const Eigen::Vector3d u = R * Eigen::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0);
      const double of_receiver = std::atan2(u.y(), u.x());
      result.push_back(sample.receiver_is_i ? of_receiver : of_receiver + yaw + std::numbers::pi);
    }
    return result;
  }

  std::vector<std::pair<double, Alignment>> starts() const {
    std::vector<std::pair<double, Alignment>> result;
    const std::size_t stride = std::max<std::size_t>(1, model_.samples().size() / 30);
    const std::size_t count = std::min(kStartLinks, model_.samples().size());
    for (std::size_t n = 0; n < count; ++n) {
      const LinkSample& sample = model_.samples()[(2 * n + 1) * model_.samples().size() / (2 * count)];
      const std::vector<double> distances =
          sample.is_angle ? std::vector<double>{2, 8, 25, 60} : std::vector<double>{sample.range_m};
      for (int y = 0; y < kStartYaws; ++y) {
        const double yaw = 2 * std::numbers::pi * y / kStartYaws;
        for (const double azimuth : directions(sample, yaw))
          for (const double distance : distances) {
            const Alignment T = start(sample, yaw, azimuth, distance);
            result.emplace_back(model_.log_likelihood(T, stride), T);
          }
      }
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const auto& x, const auto& y) { return x.first > y.first; });
    if (result.size() > kRefined) result.resize(kRefined);
    return result;
  }

  /// Expectation maximisation with Gauss-Newton steps; sigmas start wide.
  Alignment refined(Alignment T) const {
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const double widening = std::max(1.0, 4.0 - iteration);
      Eigen::Matrix4d H = Eigen::Vector4d(1e-6, 1e-6, model_.is_planar() ? 1 : 1e-4, 1e-4).asDiagonal();
      Eigen::Vector4d g = Eigen::Vector4d::Zero();
      const Neighbourhood at(T);
      for (const LinkSample& sample : model_.samples()) accumulate(sample, at, widening, H, g);
      const Eigen::Vector4d step = ldlt_solve(H, g);
      T -= step;
      if (model_.is_planar()) T(2) = 0;
      if (widening == 1 && step.norm() < 1e-4) break;
    }
    return T;
  }

  void accumulate(const LinkSample& sample, const Neighbourhood& at, double widening, Eigen::Matrix4d& H,
                  Eigen::Vector4d& g) const {
    const double r = model_.residual(sample, at.centre), sigma = widening * sample.sigma;
    const double in = model_.inlier_density(sample, r / widening) / widening,
                 out = model_.outlier_density(sample);
    const double weight = in / (in + out) / (sigma * sigma);
    if (weight < 1e-9) return;
    Eigen::Vector4d J;
    for (int k = 0; k < 4; ++k) {
      const double change = model_.residual(sample, at.moved[static_cast<std::size_t>(k)]) - r;
      J(k) = (sample.is_angle ? wrap_angle(change) : change) / kDifference;
    }
    H += weight * J * J.transpose();
    g += weight * r * J;
  }

  const LinkLikelihood& model_;
};

LinkFit described(const LinkLikelihood& model, const Alignment& T, std::size_t links) {
  LinkFit fit;
  fit.alignment = T;
  fit.links = links;
  fit.log_likelihood = model.log_likelihood(T) + model.log_likelihood_of_unplaced();
  std::size_t explained = 0;
  const Motion motion(T);
  for (const LinkSample& sample : model.samples()) {
    const double r = model.residual(sample, motion);
    if (std::abs(r) > kExplainedSigmas * sample.sigma) continue;
    ++explained;
    if (!sample.is_fix)
      (sample.is_angle ? fit.angle_residuals : fit.residuals).push_back(r / sample.own_sigma);
  }
  fit.inlier_ratio =
      static_cast<double>(explained) / static_cast<double>(std::max<std::size_t>(1, fit.links));
  return fit;
}

}  // namespace

LinkFit fit_links(const TeamLinks& team, const LinkWindow& window, const LinkFitOptions& options) {
  const LinkLikelihood model(team, window, options.alignment_sigma_m);
  const Alignment best = options.alignment ? *options.alignment : AlignmentSearch(model).sought();
  return described(model, best, window.links.size());
}

}  // namespace radioslam
