#include "radioslam/team_frame/alignment_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/team_frame/level_view.hpp"
#include "radioslam/team_frame/line_of_sight/detour_continuity.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {
namespace {

constexpr double kUniformRatio = 1 / 12.0;  // variance of a uniform density of unit width
constexpr double kNearest_m = 0.5;          // below this distance directions are undefined
constexpr double kHeadingReach = 3;         // searched around a known heading, in sigmas
constexpr double kHeightReach = 4;          // the same around the height by odometry
constexpr double kHeightSteps = 4;          // heights searched per sigma
constexpr std::size_t kMaxHeights = 2;

Eigen::Vector2d quarter_turn(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

/// The free end rotated by theta into the placed frame's orientation.
GridEnd turned(const GridEnd& end, double theta_rad) {
  const SE2 turn(Eigen::Vector2d::Zero(), theta_rad);
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r.topLeftCorner<2, 2>() = turn.rotation_matrix();
  return {turn.rotate(end.position), wrap_angle(end.heading_rad + theta_rad),
          r * end.covariance * r.transpose(), end.height_m};
}

/// A cell and the variances of the true relative pose about its centre.
struct Cell {
  Eigen::Vector2d offset;  ///< d (cos phi, sin phi)
  Eigen::Vector2d radial;
  double distance_m, variance_distance, variance_phi, variance_theta;
  double rise_m = 0, variance_height = 0;
};

/// Variance of v along `direction` from both ends' covariances and the cell's size.
double variance_along(const Eigen::Vector2d& direction, const GridEnd& a, const GridEnd& b,
                      const Cell& cell) {
  const double by_distance = direction.dot(cell.radial);
  const double by_phi = cell.distance_m * direction.dot(quarter_turn(cell.radial));
  const double by_theta = direction.dot(quarter_turn(b.position));
  return direction.dot((a.covariance + b.covariance).topLeftCorner<2, 2>() * direction) +
         by_distance * by_distance * cell.variance_distance + by_phi * by_phi * cell.variance_phi +
         by_theta * by_theta * cell.variance_theta;
}

struct Prediction {
  double value = 0, variance = 0;
};

/// Logarithm of a product of factors between 1e-100 and 1e100; takes a logarithm now and then only.
class LogOfProduct {
 public:
  void multiply_by(double factor) {
    product_ *= factor;
    if (product_ > kLarge || product_ < 1 / kLarge) {
      log_ += std::log(product_);
      product_ = 1;
    }
  }
  double value() const { return log_ + std::log(product_); }

 private:
  static constexpr double kLarge = 1e200;
  double log_ = 0, product_ = 1;
};

class Scorer {
 public:
  explicit Scorer(const GridProblem& problem) : problem_(problem) {}

  Prediction range(const GridEnd& a, const GridEnd& b, const Cell& cell) const {
    const Eigen::Vector2d v = cell.offset + b.position - a.position;
    const double height = height_between(a, b, cell), flat = std::max(v.norm(), kNearest_m);
    const double distance = std::sqrt(flat * flat + height * height);
    const double slope = height / distance, bend = cell.variance_height / distance;
    return {distance, variance_along(v / flat, a, b, cell) * (flat / distance) * (flat / distance) +
                          slope * slope * cell.variance_height + bend * bend / 2};
  }

  /// Azimuth of the other end in the receiver's frame.
  Prediction bearing(const GridEnd& a, const GridEnd& b, const Cell& cell, bool received_by_placed) const {
    const Eigen::Vector2d v = cell.offset + b.position - a.position;
    const double distance = std::max(v.norm(), kNearest_m);
    const Eigen::Vector2d across = quarter_turn(v.normalized()) / distance;
    const double direction = std::atan2(v.y(), v.x());
    const GridEnd& receiver = received_by_placed ? a : b;
    const double sign = received_by_placed ? -1 : 1;  // of the receiver's position in v
    const double value = direction - receiver.heading_rad + (received_by_placed ? 0 : std::numbers::pi);
    double variance = variance_along(across, a, b, cell) + receiver.covariance(2, 2) -
                      2 * sign * across.dot(receiver.covariance.topRightCorner<2, 1>());
    if (!received_by_placed) variance += heading_of_cell(across.dot(quarter_turn(b.position)), cell);
    return {value, variance};
  }

  /// Elevation of the other end in the receiver's levelled frame.
  Prediction elevation(const GridEnd& a, const GridEnd& b, const Cell& cell, bool received_by_placed) const {
    const Eigen::Vector2d v = cell.offset + b.position - a.position;
    const double height = height_between(a, b, cell), flat = std::max(v.norm(), kNearest_m);
    const double square = flat * flat + height * height;
    const double by_flat = height / square, by_height = flat / square;
    const double variance = by_flat * by_flat * variance_along(v / flat, a, b, cell) +
                            by_height * by_height * cell.variance_height;
    return {std::atan2(received_by_placed ? height : -height, flat), variance};
  }

  double likelihood(const GridRange& link, const GridEnd& b, const Cell& cell) const {
    const Prediction predicted = range(link.placed, b, cell);
    const double sigma = std::sqrt(predicted.variance + link.sigma_m * link.sigma_m);
    const double error = (predicted.value - link.range_m) / sigma;
    const MixtureParams& mixture = problem_.mixture;
    double density = (1 - mixture.obstructed_share) * unit_normal(error * error) /
                     (std::sqrt(2 * std::numbers::pi) * sigma);
    if (mixture.obstructed_share > 0)
      density += mixture.obstructed_share * obstructed_probability(link.range_m - predicted.value, sigma) /
                 problem_.span_m;
    return (1 - mixture.false_range_probability) * density +
           mixture.false_range_probability / problem_.span_m;
  }

  double likelihood(const GridBearing& link, const GridEnd& b, const Cell& cell) const {
    const Prediction predicted = bearing(link.placed, b, cell, link.received_by_placed);
    const double direct = problem_.mixture.direct_probability * (1 - problem_.mixture.obstructed_share);
    double density = 1 - direct;
    for (std::size_t p = 0; p < link.azimuth_rad.size(); ++p) {
      const double sigma =
          std::min(kWidestAzimuth_rad, std::sqrt(predicted.variance + link.sigma_rad[p] * link.sigma_rad[p]));
      const double error = wrap_angle(predicted.value - link.azimuth_rad[p]) / sigma;
      density += direct * link.prior[p] * std::sqrt(2 * std::numbers::pi) / sigma *
                 unit_normal(error * error) * elevation_ratio(link, p, b, cell);
    }
    return density;
  }

 private:
  double height_between(const GridEnd& a, const GridEnd& b, const Cell& cell) const {
    return problem_.height_m + cell.rise_m + b.height_m - a.height_m;
  }

  /// Density of a path's elevation relative to that of elevations without information; 1 without elevation.
  double elevation_ratio(const GridBearing& link, std::size_t p, const GridEnd& b, const Cell& cell) const {
    if (link.elevation_rad.empty() || !link.elevation_rad[p]) return 1;
    const Prediction predicted = elevation(link.placed, b, cell, link.received_by_placed);
    const double sigma = std::sqrt(predicted.variance + link.sigma_rad[p] * link.sigma_rad[p]);
    const double error = (predicted.value - *link.elevation_rad[p]) / sigma;
    return std::numbers::pi / (std::sqrt(2 * std::numbers::pi) * sigma) * unit_normal(error * error);
  }

  /// Correction where theta also rotates the receiver: (lever - 1)^2 instead of lever^2.
  static double heading_of_cell(double lever, const Cell& cell) {
    return (1 - 2 * lever) * cell.variance_theta;
  }

  const GridProblem& problem_;
};

Cell make_cell(const GridCell& at, const GridParams& params) {
  const double step = 2 * std::numbers::pi / params.angle_steps;
  const Eigen::Vector2d radial(std::cos(at.phi_rad), std::sin(at.phi_rad));
  return {at.distance_m * radial,
          radial,
          at.distance_m,
          at.sigma_distance_m * at.sigma_distance_m,
          step * step * kUniformRatio,
          step * step * kUniformRatio,
          at.rise_m,
          at.sigma_rise_m * at.sigma_rise_m};
}

/// Scores cells of one heading: the links' free ends are rotated once.
class HeadingScorer {
 public:
  HeadingScorer(const GridProblem& problem, double theta_rad) : problem_(problem), scorer_(problem) {
    for (const auto& link : problem.ranges) range_ends_.push_back(turned(link.free, theta_rad));
    for (const auto& link : problem.bearings) bearing_ends_.push_back(turned(link.free, theta_rad));
  }

  double log_likelihood(const Cell& cell) const {
    LogOfProduct product;
    for (std::size_t l = 0; l < range_ends_.size(); ++l)
      product.multiply_by(scorer_.likelihood(problem_.ranges[l], range_ends_[l], cell));
    for (std::size_t l = 0; l < bearing_ends_.size(); ++l)
      product.multiply_by(scorer_.likelihood(problem_.bearings[l], bearing_ends_[l], cell));
    return product.value();
  }

 private:
  const GridProblem& problem_;
  Scorer scorer_;
  std::vector<GridEnd> range_ends_, bearing_ends_;
};

/// Headings on the grid that are compatible with a known heading.
std::vector<double> headings(const GridProblem& problem, const GridParams& params) {
  std::vector<double> result;
  const double step = 2 * std::numbers::pi / params.angle_steps;
  for (int k = 0; k < params.angle_steps; ++k) {
    const double theta = wrap_angle(k * step);
    const bool possible = !problem.heading || std::abs(wrap_angle(theta - problem.heading->first)) <=
                                                  kHeadingReach * problem.heading->second + step;
    if (possible) result.push_back(theta);
  }
  return result;
}

/// Log likelihoods of all directions and distances at one heading; index = distance * angle_steps + phi.
std::vector<double> score_heading(const GridProblem& problem, const GridParams& params, double theta_rad) {
  const HeadingScorer scorer(problem, theta_rad);
  std::vector<double> scores;
  for (const DistanceCell& distance : problem.distances)
    for (int k = 0; k < params.angle_steps; ++k) {
      const GridCell at{distance.distance_m,
                        distance.sigma_m,
                        2 * std::numbers::pi * k / params.angle_steps,
                        theta_rad,
                        0,
                        problem.sigma_height_m,
                        0};
      scores.push_back(scorer.log_likelihood(make_cell(at, params)));
    }
  return scores;
}

/// Horizontal distance of a cell whose reference range stays the same when it is raised.
double level_distance(const GridCell& cell, double height_m, double rise_m) {
  const double before = std::hypot(cell.distance_m, height_m), after = height_m + rise_m;
  return std::sqrt(std::max(before * before - after * after, kNearest_m * kNearest_m));
}

bool neighbours(const GridCell& a, const GridCell& b, const GridParams& params) {
  const double reach = 2.5 * 2 * std::numbers::pi / params.angle_steps;
  return std::abs(wrap_angle(a.phi_rad - b.phi_rad)) < reach &&
         std::abs(wrap_angle(a.theta_rad - b.theta_rad)) < reach &&
         std::abs(std::log((a.distance_m + kNearest_m) / (b.distance_m + kNearest_m))) <
             1.5 * std::log(params.distance_ratio);
}

}  // namespace

std::vector<GridCell> best_cells(const GridProblem& problem, const GridParams& params) {
  const std::vector<double> thetas = headings(problem, params);
  std::vector<std::vector<double>> scores(thetas.size());
  parallel_for(thetas.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) scores[k] = score_heading(problem, params, thetas[k]);
  });
  std::vector<GridCell> cells;
  for (std::size_t t = 0; t < thetas.size(); ++t)
    for (std::size_t k = 0; k < scores[t].size(); ++k) {
      const auto steps = static_cast<std::size_t>(params.angle_steps);
      const DistanceCell& distance = problem.distances[k / steps];
      cells.push_back({distance.distance_m, distance.sigma_m,
                       wrap_angle(2 * std::numbers::pi * static_cast<double>(k % steps) / params.angle_steps),
                       thetas[t], 0, problem.sigma_height_m, scores[t][k]});
    }
  std::stable_sort(cells.begin(), cells.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  std::vector<GridCell> peaks;
  for (const GridCell& cell : cells) {
    if (peaks.size() == static_cast<std::size_t>(params.peaks)) break;
    const bool known = std::any_of(peaks.begin(), peaks.end(),
                                   [&](const GridCell& peak) { return neighbours(peak, cell, params); });
    if (!known) peaks.push_back(cell);
  }
  return peaks;
}

std::vector<GridCell> at_best_heights(const GridProblem& problem, const GridCell& cell,
                                      const GridParams& params) {
  if (problem.sigma_height_m == 0) return {cell};
  const HeadingScorer scorer(problem, cell.theta_rad);
  const double step = problem.sigma_height_m / kHeightSteps;
  constexpr int kSteps = static_cast<int>(kHeightReach * kHeightSteps);
  std::vector<GridCell> levels;
  for (int k = -kSteps; k <= kSteps; ++k) {
    GridCell& level = levels.emplace_back(cell);
    level.rise_m = k * step;
    level.sigma_rise_m = step;
    if (!problem.ranges.empty()) level.distance_m = level_distance(cell, problem.height_m, level.rise_m);
    const double prior = level.rise_m / problem.sigma_height_m;
    level.score = scorer.log_likelihood(make_cell(level, params)) - prior * prior / 2;
  }
  std::vector<GridCell> peaks;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const bool below = k > 0 && levels[k - 1].score > levels[k].score;
    const bool above = k + 1 < levels.size() && levels[k + 1].score >= levels[k].score;
    if (!below && !above) peaks.push_back(levels[k]);
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  if (peaks.size() > kMaxHeights) peaks.resize(kMaxHeights);
  return peaks;
}

VarianceInflation propagated_variances(const GridProblem& problem, const GridCell& at,
                                       const GridParams& params) {
  const Scorer scorer(problem);
  const Cell cell = make_cell(at, params);
  VarianceInflation inflation;
  for (const auto& link : problem.ranges)
    inflation.ranges_m2.push_back(scorer.range(link.placed, turned(link.free, at.theta_rad), cell).variance);
  for (const auto& link : problem.bearings)
    inflation.bearings_rad2.push_back(
        scorer.bearing(link.placed, turned(link.free, at.theta_rad), cell, link.received_by_placed).variance);
  return inflation;
}

}  // namespace radioslam
