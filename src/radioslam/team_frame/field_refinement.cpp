#include "radioslam/team_frame/field_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kNeighbours = 3;  // other robots that a fingerprint is compared with
constexpr double kNominalDeviations = 3;
constexpr std::size_t kMinTeam = 4;  // robots below which no typical distance is defined

/// Per node, the most similar node of each of the most similar bodies, most similar first. One per body, so
/// that an outlier does not turn its neighbours into outliers.
using Neighbours = std::vector<std::vector<Eigen::Index>>;

Eigen::Index end_of(const RigidBody& body) {
  return static_cast<Eigen::Index>(body.first_node) + body.points.cols();
}

std::vector<Eigen::Index> most_similar(const std::vector<RigidBody>& bodies, const RigidBody& own,
                                       const Eigen::RowVectorXd& similarity) {
  std::vector<std::pair<double, Eigen::Index>> others;
  for (const RigidBody& body : bodies) {
    if (&body == &own || body.points.cols() == 0) continue;
    Eigen::Index best = 0;
    const auto first = static_cast<Eigen::Index>(body.first_node);
    const double most = similarity.segment(first, body.points.cols()).maxCoeff(&best);
    if (most > 0) others.emplace_back(-most, first + best);
  }
  std::sort(others.begin(), others.end());
  others.resize(std::min(kNeighbours, others.size()));
  std::vector<Eigen::Index> nodes;
  for (const auto& other : others) nodes.push_back(other.second);
  return nodes;
}

Neighbours all_neighbours(const std::vector<RigidBody>& bodies, const Eigen::MatrixXd& similarity) {
  Neighbours neighbours(static_cast<std::size_t>(similarity.rows()));
  for (const RigidBody& body : bodies)
    for (auto i = static_cast<Eigen::Index>(body.first_node); i < end_of(body); ++i)
      neighbours[static_cast<std::size_t>(i)] = most_similar(bodies, body, similarity.row(i));
  return neighbours;
}

/// Median distance of the body's nodes to their `rank`-th most similar nodes; nothing if they have none.
std::optional<double> distance_to_ranked(const RigidBody& body, const Neighbours& neighbours,
                                         const Eigen::Matrix2Xd& positions, std::size_t rank) {
  std::vector<double> distances;
  for (auto i = static_cast<Eigen::Index>(body.first_node); i < end_of(body); ++i) {
    const auto& ranked = neighbours[static_cast<std::size_t>(i)];
    if (ranked.empty()) continue;
    const Eigen::Index j = ranked[std::min(rank, ranked.size() - 1)];
    distances.push_back((positions.col(i) - positions.col(j)).norm());
  }
  if (distances.empty()) return std::nullopt;
  return upper_median(std::move(distances));
}

/// Smallest of these medians over all ranks: small for a body whose most similar body is itself an outlier.
double distance_to_similar(const RigidBody& body, const Neighbours& neighbours,
                           const Eigen::Matrix2Xd& positions) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t rank = 0; rank < kNeighbours; ++rank)
    least = std::min(least, distance_to_ranked(body, neighbours, positions, rank).value_or(0));
  return least;
}

/// Translation that minimises the sum of the nodes' distances to the nearest of their most similar nodes.
Eigen::Vector2d best_move(const RigidBody& body, const Neighbours& neighbours,
                          const Eigen::Matrix2Xd& positions) {
  const std::size_t end = body.first_node + static_cast<std::size_t>(body.points.cols());
  const auto apart = [&](std::size_t i, Eigen::Index j) -> Eigen::Vector2d {
    return positions.col(j) - positions.col(static_cast<Eigen::Index>(i));
  };
  const auto sum_after = [&](const Eigen::Vector2d& move) {
    double sum = 0;
    for (std::size_t i = body.first_node; i < end; ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Eigen::Index j : neighbours[i]) nearest = std::min(nearest, (apart(i, j) - move).norm());
      if (!neighbours[i].empty()) sum += nearest;
    }
    return sum;
  };
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  double least = sum_after(best);
  for (std::size_t i = body.first_node; i < end; ++i)
    for (const Eigen::Index j : neighbours[i])
      if (const double sum = sum_after(apart(i, j)); sum < least) {
        least = sum;
        best = apart(i, j);
      }
  return best;
}

}  // namespace

std::vector<std::size_t> relocate_outliers(std::vector<RigidBody>& bodies,
                                           const Eigen::MatrixXd& similarity) {
  const Neighbours neighbours = all_neighbours(bodies, similarity);
  Eigen::Matrix2Xd positions = node_positions(bodies);
  std::vector<double> distances, deviations;
  std::vector<std::pair<double, std::size_t>> layout_outliers;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (const auto distance = distance_to_ranked(bodies[b], neighbours, positions, 0)) {
      distances.push_back(*distance);
      if (!bodies[b].fixed)
        layout_outliers.emplace_back(-distance_to_similar(bodies[b], neighbours, positions), b);
    }
  if (distances.size() < kMinTeam) return {};
  const double typical = upper_median(distances);
  for (const double d : distances) deviations.push_back(std::abs(d - typical));
  const double most = typical + kNominalDeviations * kMadToSigma * upper_median(deviations);
  std::sort(layout_outliers.begin(), layout_outliers.end());

  std::vector<std::size_t> moved;
  for (const auto& [negative_distance, b] : layout_outliers) {
    RigidBody& body = bodies[b];
    if (*distance_to_ranked(body, neighbours, positions, 0) <= most) continue;
    const Eigen::Vector2d move = best_move(body, neighbours, positions);
    if (move.isZero(0)) continue;
    body.T_layout_body = SE2(body.T_layout_body.translation() + move, body.T_layout_body.angle());
    positions.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols()).colwise() += move;
    moved.push_back(b);
  }
  return moved;
}

namespace {

constexpr std::size_t kMemory = 10;      // stored curvature pairs
constexpr double kEnoughDescent = 1e-4;  // Armijo constant
constexpr double kMinCurvature = 1e-10;
constexpr int kHalvings = 30;

/// A step and the change of gradient along it.
struct CurvaturePair {
  Eigen::VectorXd moved, gradient_change;
  double curvature = 0;  ///< dot product of the two
};

/// Search direction -H gradient by the two-loop recursion.
Eigen::VectorXd direction_of(const Eigen::VectorXd& gradient, const std::deque<CurvaturePair>& steps) {
  Eigen::VectorXd q = -gradient;
  std::vector<double> along(steps.size());
  for (std::size_t k = steps.size(); k-- > 0;) {
    along[k] = steps[k].moved.dot(q) / steps[k].curvature;
    q -= along[k] * steps[k].gradient_change;
  }
  if (!steps.empty()) q *= steps.back().curvature / steps.back().gradient_change.squaredNorm();
  for (std::size_t k = 0; k < steps.size(); ++k)
    q += (along[k] - steps[k].gradient_change.dot(q) / steps[k].curvature) * steps[k].moved;
  return q;
}

bool is_descent(const Eigen::VectorXd& direction, const Eigen::VectorXd& gradient) {
  const double slope = direction.dot(gradient);
  return std::isfinite(slope) && slope < 0;
}

}  // namespace

Minimum minimise_lbfgs(const SmoothFunction& function, const Eigen::VectorXd& start, int max_iterations,
                       double min_gain) {
  Minimum best{start, 0, 0};
  ValueAndGradient here = function(start);
  std::deque<CurvaturePair> steps;
  for (; best.iterations < max_iterations; ++best.iterations) {
    Eigen::VectorXd direction = direction_of(here.gradient, steps);
    if (!is_descent(direction, here.gradient)) {
      steps.clear();
      direction = -here.gradient;
    }
    double length = steps.empty() ? 1 / std::max(1.0, here.gradient.norm()) : 1;
    const double slope = direction.dot(here.gradient);
    ValueAndGradient there;
    int halvings = 0;
    for (; halvings < kHalvings; ++halvings, length /= 2) {
      there = function(best.x + length * direction);
      if (std::isfinite(there.value) && there.value <= here.value + kEnoughDescent * length * slope) break;
    }
    if (halvings == kHalvings) break;
    CurvaturePair step{length * direction, there.gradient - here.gradient, 0};
    step.curvature = step.moved.dot(step.gradient_change);
    best.x += step.moved;
    const double gain = here.value - there.value;
    here = std::move(there);
    if (step.curvature > kMinCurvature * step.gradient_change.squaredNorm()) {
      steps.push_back(std::move(step));
      if (steps.size() > kMemory) steps.pop_front();
    }
    if (gain < min_gain) break;
  }
  best.value = here.value;
  return best;
}

namespace {

constexpr double kMedianOfGaussian =
    0.6745;                        // scale at which a Cauchy and a unit Gaussian have equal medians of |x|
constexpr double kMinGain = 1e-3;  // of the cost (negative log likelihood)
constexpr double kMinSigmaScale = 1e-6;  // replaces sigma_scale = 0
// Units of the variables, chosen so that all have similar magnitude.
constexpr double kMove_m = 5, kTurn_rad = 0.1, kStretch = 0.05;

/// A body's four variables: centre, rotation and logarithm of the scale.
struct Placing {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double turn_rad = 0;
  double log_scale = 0;
};

struct FreeBody {
  std::size_t index = 0;
  Eigen::Matrix2Xd arms;  ///< points minus their mean, in the body frame
  Placing start;
};

class FieldRefinement {
 public:
  FieldRefinement(const std::vector<RigidBody>& bodies, const RadioField& field, const FieldParams& params)
      : bodies_(bodies), field_(field), params_(params), places_(node_positions(bodies)) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const RigidBody& body = bodies[b];
      if (body.fixed || body.points.cols() == 0) continue;
      const Eigen::Vector2d mean = body.points.rowwise().mean();
      free_.push_back(
          {b, body.points.colwise() - mean, {body.T_layout_body * mean, body.T_layout_body.angle(), 0}});
    }
  }

  bool has_free_bodies() const { return !free_.empty(); }

  /// Initial values: the layout's placings and the nominal kernel.
  Eigen::VectorXd start() const {
    Eigen::VectorXd x(4 * static_cast<Eigen::Index>(free_.size()) + FieldKernel::kCount);
    for (std::size_t f = 0; f < free_.size(); ++f) put(x, f, free_[f].start);
    x.tail<FieldKernel::kCount>() = FieldKernel::nominal().log;
    return x;
  }

  Placing placing(const Eigen::VectorXd& x, std::size_t f) const {
    const auto v = x.segment<4>(4 * static_cast<Eigen::Index>(f));
    return {v.head<2>() * kMove_m, v[2] * kTurn_rad, v[3] * kStretch};
  }

  ValueAndGradient operator()(const Eigen::VectorXd& x) {
    for (std::size_t f = 0; f < free_.size(); ++f) place(f, placing(x, f));
    FieldKernel kernel;
    kernel.log = x.tail<FieldKernel::kCount>();
    const FieldCost cost = field_.cost(places_, kernel);
    ValueAndGradient result{cost.value, Eigen::VectorXd::Zero(x.size())};
    for (std::size_t f = 0; f < free_.size(); ++f) add_body(f, placing(x, f), cost, result);
    add_headings(x, result);
    const FieldKernel::Vector off = (kernel.log - FieldKernel::nominal().log) / params_.sigma_kernel;
    result.value += off.squaredNorm() / 2;
    result.gradient.tail<FieldKernel::kCount>() = cost.by_kernel + off / params_.sigma_kernel;
    return result;
  }

  /// Rigid pose with the refined centre and rotation; the scale is dropped.
  SE2 pose(const Eigen::VectorXd& x, std::size_t f) const {
    const Placing p = placing(x, f);
    const SE2 turn(Eigen::Vector2d::Zero(), p.turn_rad);
    const Eigen::Vector2d mean = bodies_[free_[f].index].points.rowwise().mean();
    return {p.centre_m - turn.rotate(mean), p.turn_rad};
  }

  const std::vector<FreeBody>& free_bodies() const { return free_; }

 private:
  static void put(Eigen::VectorXd& x, std::size_t f, const Placing& p) {
    x.segment<4>(4 * static_cast<Eigen::Index>(f)) << p.centre_m / kMove_m, p.turn_rad / kTurn_rad,
        p.log_scale / kStretch;
  }

  auto places_of(std::size_t f) {
    const RigidBody& body = bodies_[free_[f].index];
    return places_.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols());
  }

  void place(std::size_t f, const Placing& p) {
    const SE2 turn(Eigen::Vector2d::Zero(), p.turn_rad);
    places_of(f) = (std::exp(p.log_scale) * turn.rotation_matrix() * free_[f].arms).colwise() + p.centre_m;
  }

  void add_body(std::size_t f, const Placing& p, const FieldCost& cost, ValueAndGradient& result) {
    const RigidBody& body = bodies_[free_[f].index];
    const Eigen::Matrix2Xd slopes =
        cost.by_position.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols());
    const Eigen::Matrix2Xd arms = places_of(f).colwise() - p.centre_m;
    const Eigen::Vector2d moved = (p.centre_m - free_[f].start.centre_m) / params_.sigma_layout_m;
    const double sigma_scale = std::max(params_.sigma_scale, kMinSigmaScale);
    const double stretched = p.log_scale / sigma_scale;
    result.value += (moved.squaredNorm() + stretched * stretched) / 2;
    auto gradient = result.gradient.segment<4>(4 * static_cast<Eigen::Index>(f));
    gradient.head<2>() = kMove_m * (slopes.rowwise().sum() + moved / params_.sigma_layout_m);
    gradient[2] = kTurn_rad * (slopes.row(1).dot(arms.row(0)) - slopes.row(0).dot(arms.row(1)));
    gradient[3] = kStretch * (slopes.cwiseProduct(arms).sum() + stretched / sigma_scale);
  }

  /// Prior that robots with a common heading rotate alike; the common heading is free unless a body is fixed.
  void add_headings(const Eigen::VectorXd& x, ValueAndGradient& result) const {
    double sine = 0, cosine = 0;
    for (const RigidBody& body : bodies_)
      if (body.fixed && body.sigma_heading_rad > 0) {
        sine += std::sin(body.T_layout_body.angle());
        cosine += std::cos(body.T_layout_body.angle());
      }
    const bool anchored = sine != 0 || cosine != 0;
    for (std::size_t f = 0; f < free_.size(); ++f)
      if (!anchored && bodies_[free_[f].index].sigma_heading_rad > 0) {
        sine += std::sin(placing(x, f).turn_rad);
        cosine += std::cos(placing(x, f).turn_rad);
      }
    const double common = std::atan2(sine, cosine);
    double pull = 0;
    std::vector<std::size_t> sharing;
    for (std::size_t f = 0; f < free_.size(); ++f) {
      const double sigma = bodies_[free_[f].index].sigma_heading_rad;
      if (sigma <= 0) continue;
      const double scale = kMedianOfGaussian * sigma,
                   off = wrap_angle(placing(x, f).turn_rad - common) / scale;
      const double slope = 2 * off / (1 + off * off) / scale;
      result.value += std::log1p(off * off);
      result.gradient[4 * static_cast<Eigen::Index>(f) + 2] += kTurn_rad * slope;
      pull += slope;
      sharing.push_back(f);
    }
    if (anchored) return;
    const double length2 = sine * sine + cosine * cosine;  // d common / d turn: derivative of a circular mean
    for (const std::size_t f : sharing) {
      const double turn = placing(x, f).turn_rad;
      const double derivative = (cosine * std::cos(turn) + sine * std::sin(turn)) / length2;
      result.gradient[4 * static_cast<Eigen::Index>(f) + 2] -= kTurn_rad * pull * derivative;
    }
  }

  const std::vector<RigidBody>& bodies_;
  const RadioField& field_;
  const FieldParams& params_;
  Eigen::Matrix2Xd places_;
  std::vector<FreeBody> free_;
};

}  // namespace

void refine_by_field(std::vector<RigidBody>& bodies, const RadioField& field, const FieldParams& params) {
  FieldRefinement refinement(bodies, field, params);
  if (!refinement.has_free_bodies()) return;
  const Minimum found = minimise_lbfgs([&](const Eigen::VectorXd& x) { return refinement(x); },
                                       refinement.start(), params.iterations, kMinGain);
  for (std::size_t f = 0; f < refinement.free_bodies().size(); ++f)
    bodies[refinement.free_bodies()[f].index].T_layout_body = refinement.pose(found.x, f);
}

}  // namespace radioslam
