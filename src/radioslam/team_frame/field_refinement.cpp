#include "radioslam/team_frame/field_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kNeighbours = 3;   // other robots that a fingerprint is compared with
constexpr Eigen::Index kMovedNodes = 8;  // of a body, that its relocation looks at
constexpr std::size_t kGiven = 120;      // nearest nodes of other bodies, whose field it looks at
constexpr double kDifferent_m = 2;       // between places worth comparing
constexpr double kMinGainOfMove = 1;     // of the cost (negative log likelihood)

/// The most similar node of each of the most similar bodies, most similar first. One per body, so that a body
/// in the wrong place does not hide the others.
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

/// Places that the body might belong to, as translations from its present one; the first is zero.
std::vector<Eigen::Vector2d> possible_moves(const FieldFit& fit, const RigidBody& body,
                                            const std::vector<Eigen::Index>& nodes,
                                            const Eigen::Matrix2Xd& places,
                                            const Eigen::MatrixXd& similarity) {
  std::vector<Eigen::Vector2d> moves{Eigen::Vector2d::Zero()};
  for (const Eigen::Index i : nodes)
    for (const Eigen::Index j : most_similar(fit.bodies, body, similarity.row(i))) {
      const Eigen::Vector2d move = places.col(j) - places.col(i);
      if (std::all_of(moves.begin(), moves.end(),
                      [&](const auto& known) { return (known - move).norm() > kDifferent_m; }))
        moves.push_back(move);
    }
  return moves;
}

/// The nodes of other bodies nearest to any of `at`, nearest first.
std::vector<Eigen::Index> nodes_around(const Eigen::Matrix2Xd& at, const RigidBody& body,
                                       const Eigen::Matrix2Xd& places) {
  const auto first = static_cast<Eigen::Index>(body.first_node), end = first + body.points.cols();
  std::vector<std::pair<double, Eigen::Index>> others;
  for (Eigen::Index j = 0; j < places.cols(); ++j)
    if (j < first || j >= end)
      others.emplace_back((at.colwise() - places.col(j)).colwise().squaredNorm().minCoeff(), j);
  const std::size_t most = std::min(kGiven, others.size());
  std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(most), others.end());
  std::vector<Eigen::Index> nodes;
  for (std::size_t k = 0; k < most; ++k) nodes.push_back(others[k].second);
  return nodes;
}

/// The move of least cost; zero unless another one is clearly better.
Eigen::Vector2d best_move(const FieldFit& fit, const RigidBody& body, const Eigen::Matrix2Xd& places,
                          const TeamField& team) {
  const Eigen::Index count = body.points.cols();
  std::vector<Eigen::Index> nodes;
  for (Eigen::Index k = 0; k < count; k += (count + kMovedNodes - 1) / kMovedNodes)
    nodes.push_back(static_cast<Eigen::Index>(body.first_node) + k);
  const auto moves = possible_moves(fit, body, nodes, places, team.similarity);
  std::vector<double> costs(moves.size());
  parallel_for(moves.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) {
      const Eigen::Matrix2Xd at = places(Eigen::all, nodes).colwise() + moves[m];
      costs[m] = team.field.conditional_cost(nodes, at, nodes_around(at, body, places), places, fit.model);
    }
  });
  const auto best = static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  return costs[best] < costs[0] - kMinGainOfMove ? moves[best] : moves[0];
}

}  // namespace

std::vector<std::size_t> relocate_by_field(FieldFit& fit, const TeamField& team) {
  std::vector<std::size_t> moved;
  Eigen::Matrix2Xd places = node_positions(fit.bodies);
  for (std::size_t b = 0; b < fit.bodies.size(); ++b) {
    RigidBody& body = fit.bodies[b];
    if (body.fixed || body.points.cols() == 0) continue;
    const Eigen::Vector2d move = best_move(fit, body, places, team);
    if (move.isZero(0)) continue;
    body.T_layout_body = SE2(body.T_layout_body.translation() + move, body.T_layout_body.angle());
    places.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols()).colwise() += move;
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
  FieldRefinement(const FieldFit& fit, const RadioField& field, const FieldParams& params)
      : bodies_(fit.bodies),
        begin_(fit.model),
        nominal_(FieldModel::nominal(fit.bodies.size())),
        field_(field),
        params_(params),
        places_(node_positions(fit.bodies)) {
    const std::vector<RigidBody>& bodies = fit.bodies;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const RigidBody& body = bodies[b];
      if (body.fixed || body.points.cols() == 0) continue;
      const Eigen::Vector2d mean = body.points.rowwise().mean();
      free_.push_back(
          {b, body.points.colwise() - mean, {body.T_layout_body * mean, body.T_layout_body.angle(), 0}});
    }
  }

  bool has_free_bodies() const { return !free_.empty(); }

  /// Initial values: the fit's placings and model.
  Eigen::VectorXd start() const {
    Eigen::VectorXd x(kernel_at() + FieldKernel::kCount + begin_.log_losses.size());
    for (std::size_t f = 0; f < free_.size(); ++f) put(x, f, free_[f].start);
    x.segment<FieldKernel::kCount>(kernel_at()) = begin_.kernel.log;
    x.tail(begin_.log_losses.size()) = begin_.log_losses;
    return x;
  }

  FieldModel model(const Eigen::VectorXd& x) const {
    return {{x.segment<FieldKernel::kCount>(kernel_at())}, x.tail(begin_.log_losses.size())};
  }

  Placing placing(const Eigen::VectorXd& x, std::size_t f) const {
    const auto v = x.segment<4>(4 * static_cast<Eigen::Index>(f));
    return {v.head<2>() * kMove_m, v[2] * kTurn_rad, v[3] * kStretch};
  }

  ValueAndGradient operator()(const Eigen::VectorXd& x) {
    for (std::size_t f = 0; f < free_.size(); ++f) place(f, placing(x, f));
    const FieldModel here = model(x);
    const FieldCost cost = field_.cost(places_, here);
    ValueAndGradient result{cost.value, Eigen::VectorXd::Zero(x.size())};
    for (std::size_t f = 0; f < free_.size(); ++f) add_body(f, placing(x, f), cost, result);
    add_headings(x, result);
    const FieldKernel::Vector off = (here.kernel.log - nominal_.kernel.log) / params_.sigma_kernel;
    const Eigen::VectorXd lost = here.log_losses - nominal_.log_losses;
    result.value += (off.squaredNorm() + lost.squaredNorm()) / 2;
    result.gradient.segment<FieldKernel::kCount>(kernel_at()) = cost.by_kernel + off / params_.sigma_kernel;
    result.gradient.tail(lost.size()) = cost.by_loss + lost;
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
  Eigen::Index kernel_at() const { return 4 * static_cast<Eigen::Index>(free_.size()); }

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
  const FieldModel& begin_;
  const FieldModel nominal_;
  const RadioField& field_;
  const FieldParams& params_;
  Eigen::Matrix2Xd places_;
  std::vector<FreeBody> free_;
};

/// Root mean square distance of the nodes from their mean.
double size_m(const std::vector<RigidBody>& bodies) {
  const Eigen::Matrix2Xd places = node_positions(bodies);
  return std::sqrt((places.colwise() - places.rowwise().mean()).colwise().squaredNorm().mean());
}

/// Moves the bodies towards their common centre, or away from it, as rigid bodies.
void resize(std::vector<RigidBody>& bodies, double factor) {
  const Eigen::Vector2d centre = node_positions(bodies).rowwise().mean();
  for (RigidBody& body : bodies) {
    if (body.points.cols() == 0) continue;
    const Eigen::Vector2d mean = body.T_layout_body * Eigen::Vector2d(body.points.rowwise().mean());
    body.T_layout_body =
        SE2(body.T_layout_body.translation() + (factor - 1) * (mean - centre), body.T_layout_body.angle());
  }
}

}  // namespace

void refine_by_field(FieldFit& fit, const RadioField& field, const FieldParams& params) {
  FieldRefinement refinement(fit, field, params);
  if (!refinement.has_free_bodies()) return;
  const Minimum found = minimise_lbfgs([&](const Eigen::VectorXd& x) { return refinement(x); },
                                       refinement.start(), params.iterations, kMinGain);
  std::vector<RigidBody> placed = fit.bodies;
  for (std::size_t f = 0; f < refinement.free_bodies().size(); ++f)
    placed[refinement.free_bodies()[f].index].T_layout_body = refinement.pose(found.x, f);
  fit = {std::move(placed), refinement.model(found.x), 0};
  fit.cost = field.cost(node_positions(fit.bodies), fit.model).value;
}

void advance_by_field(FieldFit& fit, const TeamField& team, const FieldParams& params, bool is_first) {
  if (!is_first) relocate_by_field(fit, team);
  const double before_m = size_m(fit.bodies);
  refine_by_field(fit, team.field, params);
  const double after_m = size_m(fit.bodies);
  const bool is_held =
      std::any_of(fit.bodies.begin(), fit.bodies.end(), [](const RigidBody& body) { return body.fixed; });
  if (!is_held && after_m > 0) resize(fit.bodies, before_m / after_m);
}

}  // namespace radioslam
