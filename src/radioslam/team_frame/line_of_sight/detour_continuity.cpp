#include "radioslam/team_frame/line_of_sight/detour_continuity.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/team_frame/level_view.hpp"
#include "radioslam/team_frame/line_of_sight/sight_chains.hpp"
#include "radioslam/team_frame/odometry_compression.hpp"

namespace radioslam {
namespace {

constexpr double kTail = -5;  // below, phi / Phi follows from a continued fraction
constexpr int kTerms = 40;

/// phi(y) / Phi(y) + y; tends to -1 / y in the lower tail.
double hazard_and_argument(double y, double distribution) {
  if (y > kTail) return std::exp(-y * y / 2) / (std::sqrt(2 * std::numbers::pi) * distribution) + y;
  double fraction = 0;  // phi / Phi = t + 1 / (t + 2 / (t + 3 / ...)) with t = -y
  for (int k = kTerms; k > 0; --k) fraction = k / (-y + fraction);
  return fraction;
}

}  // namespace

double obstructed_probability(double x, double sigma) {
  return std::erfc(-(x / sigma) / std::numbers::sqrt2) / 2;
}

ObstructedRange obstructed_range(double x, double sigma) {
  const double y = x / sigma;
  ObstructedRange result;
  result.probability = obstructed_probability(x, sigma);
  const double sum = hazard_and_argument(y, result.probability), hazard = sum - y;
  result.slope = hazard / sigma;
  result.curvature = hazard * sum / (sigma * sigma);
  return result;
}

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kOdometryError = 0.05;  // of the distance driven between two exchanges
constexpr double kSameTime_s = 1e-3;     // between the ranges of one exchange
constexpr double kExchange_s = 0.5;      // between a range and its angles
constexpr double kWithAngles_s = 2;      // to an earlier exchange with angles, if the last one has none
constexpr double kWithinExchange_m = 1;  // standard deviation, by antennas and motion
constexpr double kNegligible = 7;        // standard deviations of a range that was not predicted
constexpr double kNearest_m = 0.5;       // below this distance directions are undefined

struct Azimuth {
  double value_rad = 0, sigma_rad = 1, probability = 0;
};

/// A range and the angles at the two ends, of two robots.
struct Exchange {
  std::size_t range = 0;
  double range_m = 0, sigma_m = 1;
  Stamp stamp;
  SE2 T_a, T_b;  ///< of the antennas, in the robots' own frames, with the headings of the poses they are on
  std::vector<Azimuth> at_a, at_b;
  std::vector<std::size_t> further;  ///< ranges of the same exchange
};

/// Relative pose of an exchange as (range, azimuth at a, azimuth at b).
Eigen::Vector3d measured_from(const SE2& T_a_b) {
  const Eigen::Vector2d v = T_a_b.translation();
  const double azimuth = std::atan2(v.y(), v.x());
  return {v.norm(), azimuth, azimuth + kPi - T_a_b.angle()};
}
SE2 relative_pose(const Eigen::Vector3d& m) {
  return {m[0] * Eigen::Vector2d(std::cos(m[1]), std::sin(m[1])), m[1] + kPi - m[2]};
}

struct Prediction {
  Eigen::Vector3d mean;
  Eigen::Matrix3d covariance;
};

/// The exchange after both ends moved.
Prediction moved(const Eigen::Vector3d& from, const Eigen::Vector3d& sigma, const SE2& T_a_moved,
                 const SE2& T_b_moved) {
  const auto predicted = [&](const Eigen::Vector3d& m) {
    return measured_from(T_a_moved.inverse() * relative_pose(m) * T_b_moved);
  };
  Prediction result{predicted(from), Eigen::Matrix3d::Zero()};
  for (int k = 0; k < 3; ++k) {
    Eigen::Vector3d shifted = from;
    shifted[k] += sigma[k];
    Eigen::Vector3d change = predicted(shifted) - result.mean;
    for (int n = 1; n < 3; ++n) change[n] = wrap_angle(change[n]);
    result.covariance += change * change.transpose();
  }
  const double odometry_m =
      kOdometryError * (T_a_moved.translation().norm() + T_b_moved.translation().norm());
  const double across = odometry_m / std::max(result.mean[0], kNearest_m);
  result.covariance.diagonal() += Eigen::Vector3d(odometry_m * odometry_m, across * across, across * across);
  return result;
}

double normal_density(double error, double variance) {
  return std::exp(-error * error / (2 * variance)) / std::sqrt(2 * kPi * variance);
}

/// Density of the components of `error` that are present.
double normal_density(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance,
                      const std::array<bool, 3>& present) {
  // Components that are absent get a unit variance of their own, and no error.
  Eigen::Matrix3d c = covariance;
  Eigen::Vector3d e = error;
  double dimension = 0;
  for (int k = 0; k < 3; ++k) {
    if (present[static_cast<std::size_t>(k)]) {
      ++dimension;
      continue;
    }
    c.row(k).setZero();
    c.col(k).setZero();
    c(k, k) = 1;
    e[k] = 0;
  }
  const double squared = e.dot(inverse(c) * e);
  return std::exp(-squared / 2) / std::sqrt(std::pow(2 * kPi, dimension) * c.determinant());
}

/// An angle's paths, and that none of them is the one round the corner.
std::vector<std::optional<Azimuth>> choices(const std::vector<Azimuth>& paths) {
  std::vector<std::optional<Azimuth>> all(paths.begin(), paths.end());
  all.emplace_back();
  return all;
}
double none_probability(const std::vector<Azimuth>& paths) {
  double none = 1;
  for (const Azimuth& path : paths) none -= path.probability;
  return none;
}

/// Density of an exchange given its prediction, relative to uniform angles.
double density(const Exchange& exchange, const Prediction& predicted) {
  const double off_m = exchange.range_m - predicted.mean[0];
  const double variance = predicted.covariance(0, 0) + exchange.sigma_m * exchange.sigma_m;
  if (off_m * off_m > kNegligible * kNegligible * variance) return 0;
  const auto at_a = choices(exchange.at_a), at_b = choices(exchange.at_b);
  double sum = 0;
  for (const auto& a : at_a)
    for (const auto& b : at_b) {
      Eigen::Vector3d error(off_m, 0, 0);
      Eigen::Matrix3d covariance = predicted.covariance;
      covariance(0, 0) = variance;
      double weight = a ? a->probability * 2 * kPi : none_probability(exchange.at_a);
      weight *= b ? b->probability * 2 * kPi : none_probability(exchange.at_b);
      if (a) {
        error[1] = wrap_angle(a->value_rad - predicted.mean[1]);
        covariance(1, 1) += a->sigma_rad * a->sigma_rad;
      }
      if (b) {
        error[2] = wrap_angle(b->value_rad - predicted.mean[2]);
        covariance(2, 2) += b->sigma_rad * b->sigma_rad;
      }
      sum += weight * normal_density(error, covariance, {true, a.has_value(), b.has_value()});
    }
  return sum;
}

/// Density of an exchange given the preceding one, relative to uniform angles.
double density(const Exchange& exchange, const Exchange& before) {
  const SE2 T_a_moved = before.T_a.inverse() * exchange.T_a, T_b_moved = before.T_b.inverse() * exchange.T_b;
  double sum = 0, unknown = 1;
  for (const Azimuth& a : before.at_a)
    for (const Azimuth& b : before.at_b) {
      const double probability = a.probability * b.probability;
      unknown -= probability;
      sum += probability *
             density(exchange, moved({before.range_m, a.value_rad, b.value_rad},
                                     {before.sigma_m, a.sigma_rad, b.sigma_rad}, T_a_moved, T_b_moved));
    }
  const double motion2 = T_a_moved.translation().squaredNorm() + T_b_moved.translation().squaredNorm();
  const double variance = motion2 / 2 + std::pow(before.sigma_m, 2) + std::pow(exchange.sigma_m, 2);
  return sum + unknown * normal_density(exchange.range_m - before.range_m, variance);
}

/// The last exchange before k with angles at both ends, unless it is long ago; else the last one.
std::size_t predecessor(const std::vector<Exchange>& exchanges, std::size_t k) {
  for (std::size_t n = k; n-- > 0;) {
    if (seconds_between(exchanges[n].stamp, exchanges[k].stamp) > kWithAngles_s) break;
    if (!exchanges[n].at_a.empty() && !exchanges[n].at_b.empty()) return n;
  }
  return k - 1;
}

/// Density of a range given another of the same exchange: both have the detour's length.
double repeated_density(double difference_m, double sigma_m, double other_sigma_m) {
  return normal_density(difference_m, sigma_m * sigma_m + other_sigma_m * other_sigma_m +
                                          kWithinExchange_m * kWithinExchange_m);
}

/// Poses by odometry alone, from the first pose of every segment on: the densities must not depend on the
/// estimate.
template <class Pose>
std::vector<Pose> odometry_poses(const TeamGraph<Pose>& team) {
  const auto into = odometry_into(team);
  std::vector<Pose> poses = team.graph.poses;
  for (const TrajectorySegment& segment : team.segments)
    for (std::size_t k = segment.first_pose + 1; k < segment.first_pose + segment.pose_count; ++k)
      if (into[k] != kNoOdometry)
        poses[k] = poses[k - 1] * team.graph.relative_poses[static_cast<std::size_t>(into[k])].T_i_j;
  return poses;
}

/// Exchanges of one pair of robots.
template <class Pose>
class Exchanges {
 public:
  Exchanges(const TeamGraph<Pose>& team, const std::vector<double>& path_prior, double direct_probability)
      : team_(team),
        poses_(odometry_poses(team)),
        path_prior_(path_prior),
        direct_probability_(direct_probability) {
    first_path_.push_back(0);
    for (const auto& bearing : team.bearings)
      first_path_.push_back(first_path_.back() + bearing.paths.size());
  }

  /// Of successive links between two robots, `at_a` being those at the end with the lower pose. Ranges
  /// at the same time are one exchange, and angles belong to the nearest one.
  std::vector<Exchange> of(const std::vector<TimedLink>& links) const {
    std::vector<Exchange> exchanges;
    for (const TimedLink& link : links) {
      if (link.measurement >= team_.graph.ranges.size()) continue;
      const bool is_new =
          exchanges.empty() || seconds_between(exchanges.back().stamp, link.stamp) > kSameTime_s;
      if (is_new)
        exchanges.push_back(begin(link));
      else
        exchanges.back().further.push_back(link.measurement);
    }
    for (const TimedLink& link : links)
      if (link.measurement >= team_.graph.ranges.size())
        if (Exchange* nearest = nearest_in_time(exchanges, link.stamp)) add(link, *nearest);
    return exchanges;
  }

 private:
  static Exchange* nearest_in_time(std::vector<Exchange>& exchanges, Stamp stamp) {
    const auto later =
        std::lower_bound(exchanges.begin(), exchanges.end(), stamp,
                         [](const Exchange& exchange, Stamp at) { return exchange.stamp < at; });
    Exchange* nearest = nullptr;
    double gap_s = kExchange_s;
    const auto consider = [&](Exchange& exchange) {
      const double own_s = std::abs(seconds_between(exchange.stamp, stamp));
      if (own_s <= gap_s) gap_s = own_s, nearest = &exchange;
    };
    if (later != exchanges.begin()) consider(*(later - 1));
    if (later != exchanges.end()) consider(*later);
    return nearest;
  }

  SE2 place(const RangeEnd<Pose>& end) const {
    const Pose& pose = poses_[end.pose.index()];
    return {(pose * end.lever_arm).template head<2>(), seen_from_above(pose).angle()};
  }

  Exchange begin(const TimedLink& link) const {
    const auto& range = team_.graph.ranges[link.measurement];
    const bool is_in_order = range.i.pose.value < range.j.pose.value;
    Exchange exchange;
    exchange.range = link.measurement;
    exchange.range_m = range.range_m;
    exchange.sigma_m = range.sigma_m;
    exchange.stamp = link.stamp;
    exchange.T_a = place(is_in_order ? range.i : range.j);
    exchange.T_b = place(is_in_order ? range.j : range.i);
    return exchange;
  }

  /// Adds an angle, seen with the receiver's heading at the time of the exchange.
  void add(const TimedLink& link, Exchange& exchange) const {
    const std::size_t b = link.measurement - team_.graph.ranges.size();
    const auto& bearing = team_.bearings[b];
    const bool is_at_a = bearing.i.value < bearing.j.pose.value;
    auto& azimuths = is_at_a ? exchange.at_a : exchange.at_b;
    if (!azimuths.empty()) return;
    const Pose& receiver = poses_[bearing.i.index()];
    const double turned = seen_from_above(receiver).angle() - (is_at_a ? exchange.T_a : exchange.T_b).angle();
    for (std::size_t p = 0; p < bearing.paths.size(); ++p)
      azimuths.push_back({level_azimuth(receiver, direction_in_body(bearing, p)) + turned,
                          bearing.paths[p].sigma_rad, direct_probability_ * path_prior_[first_path_[b] + p]});
  }

  const TeamGraph<Pose>& team_;
  std::vector<Pose> poses_;
  const std::vector<double>& path_prior_;
  double direct_probability_;
  std::vector<std::size_t> first_path_;
};

}  // namespace

template <class Pose>
std::vector<double> detour_densities(const TeamGraph<Pose>& team, const std::vector<double>& path_prior,
                                     const DetourModel& model) {
  std::vector<double> result(team.graph.ranges.size(), 1 / model.span_m);
  const Exchanges<Pose> exchanges(team, path_prior, model.direct_probability);
  for (const auto& links : links_by_pair(team)) {
    if (!links.is_between_robots) continue;
    const std::vector<Exchange> own = exchanges.of(links.links);
    for (std::size_t k = 1; k < own.size(); ++k) {
      const Exchange& before = own[predecessor(own, k)];
      const double continues =
          std::exp(-seconds_between(before.stamp, own[k].stamp) / model.correlation_time_s);
      result[own[k].range] = (1 - continues) / model.span_m + continues * density(own[k], before);
    }
    for (const Exchange& exchange : own)
      for (const std::size_t range : exchange.further)
        result[range] = repeated_density(team.graph.ranges[range].range_m - exchange.range_m,
                                         team.graph.ranges[range].sigma_m, exchange.sigma_m);
  }
  return result;
}

template std::vector<double> detour_densities(const TeamGraph<SE2>&, const std::vector<double>&,
                                              const DetourModel&);
template std::vector<double> detour_densities(const TeamGraph<SE3>&, const std::vector<double>&,
                                              const DetourModel&);

}  // namespace radioslam
