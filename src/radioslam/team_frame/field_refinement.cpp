#include "radioslam/team_frame/field_refinement.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/team_frame/lbfgs.hpp"

namespace radioslam {
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
