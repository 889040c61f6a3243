// Graphs with every kind of factor, drawn around known values.
#pragma once

#include "radioslam/base/random.hpp"
#include "radioslam/graph/factor_lists.hpp"
#include "radioslam/graph/pose_graph.hpp"

namespace radioslam::test {

template <class Pose>
struct Drawing {
  static constexpr int kDim = Pose::kDim, kDof = Pose::kDof, kRotation = kDof - kDim;
  using Point = typename Pose::Point;
  using Tangent = typename Pose::Tangent;

  explicit Drawing(std::uint64_t seed) : rng(seed) {}

  template <int N>
  Eigen::Matrix<double, N, 1> normals(double sigma) {
    Eigen::Matrix<double, N, 1> v;
    for (int k = 0; k < N; ++k) v[k] = rng.normal(0, sigma);
    return v;
  }
  Point point(double metres) { return normals<kDim>(metres); }
  Tangent tangent(double metres, double radians) {
    Tangent xi;
    xi << normals<kDim>(metres), normals<kRotation>(radians);
    return xi;
  }
  Pose pose(double metres, double radians) { return Pose::exp(tangent(metres, radians)); }
  template <int N>
  Eigen::Matrix<double, N, N> information() {
    Eigen::Matrix<double, N, N> a;
    for (int k = 0; k < N; ++k) a.col(k) = normals<N>(1);
    return a * a.transpose() + Eigen::Matrix<double, N, N>::Identity();
  }

  Rng rng;
};

/// What a drawn graph holds beside a chain of poses with loops.
enum class Extras { kNone, kAll };

/// Draws a graph step by step; every step uses up random numbers, so their order is part of a graph's seed.
/// Measurements are exact for the graph's values when `noise` is zero, else off by about noise * 0.1.
template <class Pose>
class GraphDrawing {
 public:
  static constexpr int kDim = Pose::kDim, kDof = Pose::kDof;
  using Point = typename Pose::Point;

  GraphDrawing(std::uint64_t seed, double noise) : draw_(seed), noise_(noise) {}

  const PoseGraph<Pose>& graph() const { return graph_; }

  void add_walk(std::size_t count) {
    Pose pose;
    for (std::size_t i = 0; i < count; ++i) {
      graph_.poses.push_back(pose);
      pose = pose * draw_.pose(0.3, 0.4) * Pose::exp(Pose::Tangent::Unit(0) * 2.0);
    }
  }

  void add_points_drift_and_bias() {
    graph_.points = {draw_.point(5), draw_.point(5)};
    graph_.drifts = {Drift(0.02, -0.05)};
    graph_.range_biases = {0.3, 0.2};
  }

  void add_relative(std::size_t i, std::size_t j, DriftId drift) {
    RelativePoseFactor<Pose> f;
    f.i = PoseId(i);
    f.j = PoseId(j);
    f.information = 10 * draw_.template information<kDof>();
    Pose exact = graph_.poses[i].inverse() * graph_.poses[j];
    if (drift.valid()) {
      f.drift = drift;
      for (int c = 0; c < 2; ++c) f.drift_jacobian.col(c) = draw_.template normals<kDof>(1);
      if (graph_.chart == PoseChart::kLogarithm)
        exact = exact * Pose::exp(-f.drift_jacobian * graph_.drifts[drift.index()]);
    }
    f.T_i_j = measured(exact);
    graph_.relative_poses.push_back(f);
  }

  void add_range(std::size_t i) {
    RangeFactor<Pose> range{end_at(i), i % 3 == 0 ? end_at(i + 3) : point(i % 2), 0, 0.2, {}, 1};
    const double exact_m = (place(range.j) - place(range.i)).norm();
    range.range_m = exact_m + 0.1 * noise_ * draw_.rng.normal();
    if (i % 4 == 1) {
      range.drift = DriftId(0);
      range.range_m += exact_m * (1 / (1 - graph_.drifts[0][1]) - 1);
    }
    if (i % 2 == 0) {
      range.bias = BiasId(0);
      range.range_m += graph_.range_biases[0];
    }
    graph_.ranges.push_back(range);
  }

  void add_bearing(std::size_t i) {
    BearingFactor<Pose> bearing{PoseId(i), i % 2 == 0 ? end_at(i + 2) : point(i % 2), {}, 0.1, {}, 1};
    if (i % 3 != 0) bearing.T_i_receiver = draw_.pose(0.3, 0.4);
    const Point seen = (graph_.poses[i] * bearing.T_i_receiver).inverse() * place(bearing.j);
    bearing.direction = (seen.normalized() + draw_.point(0.05 * noise_)).normalized();
    graph_.bearings.push_back(bearing);
  }

  void add_position(std::size_t i) {
    PositionFactor<Pose> position{end_at(i), {}, draw_.template information<kDim>(), {}, 1};
    position.position = place(position.i) + draw_.point(0.1 * noise_);
    graph_.positions.push_back(position);
  }

  void add_sighting(std::size_t i) {
    RelativePointFactor<Pose> sighting;
    sighting.i = PoseId(i);
    sighting.j = i % 4 == 0 ? end_at(i + 4) : point(i / 4 % 2);
    sighting.position = graph_.poses[i].inverse() * place(sighting.j) + draw_.point(0.1 * noise_);
    sighting.information = draw_.template information<kDim>();
    graph_.relative_points.push_back(sighting);
  }

  void add_priors(std::size_t pose) {
    PositionFactor<Pose> of_point{point(1), graph_.points[1], {}, {}, 1};
    of_point.information.setIdentity();
    graph_.positions.push_back(of_point);
    graph_.pose_priors.push_back(
        {PoseId(pose), measured(graph_.poses[pose]), draw_.template information<kDof>(), {}, 0.5});
    graph_.drift_priors.push_back({DriftId(0), graph_.drifts[0], 100 * draw_.template information<2>()});
    graph_.range_bias_priors.push_back(
        {BiasId(0), BiasId(1), graph_.range_biases[0] - graph_.range_biases[1], 0.5});
    graph_.range_bias_priors.push_back({BiasId(1), {}, graph_.range_biases[1], 0.4});
  }

 private:
  Pose measured(const Pose& exact) { return exact * draw_.pose(0.1 * noise_, 0.05 * noise_); }
  RangeEnd<Pose> end_at(std::size_t pose) { return {PoseId(pose), {}, draw_.point(0.3)}; }
  static RangeEnd<Pose> point(std::size_t index) { return {{}, PointId(index), Point::Zero()}; }
  Point place(const RangeEnd<Pose>& end) const {
    if (!end.pose.valid()) return graph_.points[end.point.index()];
    return graph_.poses[end.pose.index()] * end.lever_arm;
  }

  Drawing<Pose> draw_;
  double noise_;
  PoseGraph<Pose> graph_;
};

/// A trajectory of `count` poses; a relative pose for every step and for loops of 5; with extras, ranges
/// between poses, with lever arms, and to points, bearings, sightings, positions, priors, one drift in the
/// odometry and in every fourth range, and one bias of every other range with another above it.
template <class Pose>
PoseGraph<Pose> draw_graph(std::uint64_t seed, std::size_t count, double noise, Extras extras) {
  GraphDrawing<Pose> drawing(seed, noise);
  const bool rich = extras == Extras::kAll;
  drawing.add_walk(count);
  if (rich) drawing.add_points_drift_and_bias();
  for (std::size_t i = 0; i + 1 < count; ++i) drawing.add_relative(i, i + 1, rich ? DriftId(0) : DriftId());
  for (std::size_t i = 0; i + 5 < count; i += 2) drawing.add_relative(i, i + 5, {});
  if (!rich) return drawing.graph();

  for (std::size_t i = 0; i + 3 < count; ++i) {
    drawing.add_range(i);
    drawing.add_bearing(i);
  }
  for (std::size_t i = 0; i < count; i += 4) drawing.add_position(i);
  drawing.add_priors(count / 2);
  for (std::size_t i = 0; i + 4 < count; i += 2) drawing.add_sighting(i);
  return drawing.graph();
}

/// Moves every pose but the first, and every point, drift and bias.
template <class Pose>
void disturb(PoseGraph<Pose>& graph, std::uint64_t seed, double amount) {
  Drawing<Pose> draw(seed);
  for (std::size_t i = 1; i < graph.poses.size(); ++i)
    graph.poses[i] = graph.poses[i] * draw.pose(amount, amount);
  for (auto& point : graph.points) point += draw.point(amount);
  for (auto& drift : graph.drifts) drift += 0.1 * amount * draw.template normals<2>(1);
  for (auto& bias : graph.range_biases) bias += amount;
}

/// The largest difference of any pose, point, drift or bias.
template <class Pose>
double max_difference(const PoseGraph<Pose>& a, const PoseGraph<Pose>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.poses.size(); ++i)
    worst = std::max(worst, (a.poses[i].inverse() * b.poses[i]).log().norm());
  for (std::size_t i = 0; i < a.points.size(); ++i)
    worst = std::max(worst, (a.points[i] - b.points[i]).norm());
  for (std::size_t i = 0; i < a.drifts.size(); ++i)
    worst = std::max(worst, (a.drifts[i] - b.drifts[i]).norm());
  for (std::size_t i = 0; i < a.range_biases.size(); ++i)
    worst = std::max(worst, std::abs(a.range_biases[i] - b.range_biases[i]));
  return worst;
}

using PoseTypes = testing::Types<SE2, SE3>;

}  // namespace radioslam::test
