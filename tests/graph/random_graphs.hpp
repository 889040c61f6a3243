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

/// Sightings of poses and points from poses, off by about noise * 0.1.
template <class Pose>
void add_relative_points(PoseGraph<Pose>& graph, Drawing<Pose>& draw, double noise) {
  for (std::size_t i = 0; i + 4 < graph.poses.size(); i += 2) {
    RelativePointFactor<Pose> sighting;
    sighting.i = PoseId(i);
    if (i % 4 == 0)
      sighting.j = {PoseId(i + 4), {}, draw.point(0.3)};
    else
      sighting.j.point = PointId(i % graph.points.size());
    const typename Pose::Point place =
        i % 4 == 0 ? graph.poses[i + 4] * sighting.j.lever_arm : graph.points[sighting.j.point.index()];
    sighting.position = graph.poses[i].inverse() * place + draw.point(0.1 * noise);
    sighting.information = draw.template information<Pose::kDim>();
    graph.relative_points.push_back(sighting);
  }
}

/// What a drawn graph holds beside a chain of poses with loops.
enum class Extras { kNone, kAll };

/// A walk of `count` poses; a relative pose for every step and for loops of 5; with extras, ranges between
/// poses, with lever arms, and to points, bearings, sightings, positions, priors, and one drift in the
/// odometry. Measurements are exact for the graph's values when `noise` is zero, else off by about noise *
/// 0.1.
template <class Pose>
PoseGraph<Pose> draw_graph(std::uint64_t seed, std::size_t count, double noise, Extras extras) {
  Drawing<Pose> draw(seed);
  constexpr int kDim = Pose::kDim, kDof = Pose::kDof;
  PoseGraph<Pose> graph;
  Pose pose;
  for (std::size_t i = 0; i < count; ++i) {
    graph.poses.push_back(pose);
    pose = pose * draw.pose(0.3, 0.4) * Pose::exp(Pose::Tangent::Unit(0) * 2.0);
  }
  const bool rich = extras == Extras::kAll;
  if (rich) {
    graph.points = {draw.point(5), draw.point(5)};
    graph.drifts = {Drift(0.02, -0.05)};
  }
  const auto measured = [&](const Pose& exact) { return exact * draw.pose(0.1 * noise, 0.05 * noise); };
  const auto id = [](std::size_t k) { return PoseId(k); };
  const auto add_relative = [&](std::size_t i, std::size_t j, DriftId drift) {
    RelativePoseFactor<Pose> f;
    f.i = id(i);
    f.j = id(j);
    f.information = 10 * draw.template information<kDof>();
    Pose exact = graph.poses[i].inverse() * graph.poses[j];
    if (drift.valid()) {
      f.drift = drift;
      for (int c = 0; c < 2; ++c) f.drift_jacobian.col(c) = draw.template normals<kDof>(1);
      if (graph.chart == PoseChart::kLogarithm)
        exact = exact * Pose::exp(-f.drift_jacobian * graph.drifts[drift.index()]);
    }
    f.T_i_j = measured(exact);
    graph.relative_poses.push_back(f);
  };
  for (std::size_t i = 0; i + 1 < count; ++i) add_relative(i, i + 1, rich ? DriftId(0) : DriftId());
  for (std::size_t i = 0; i + 5 < count; i += 2) add_relative(i, i + 5, {});
  if (!rich) return graph;

  const auto end_at = [&](std::size_t pose_index) {
    return RangeEnd<Pose>{id(pose_index), {}, draw.point(0.3)};
  };
  const auto place = [&](const RangeEnd<Pose>& e) {
    return e.pose.valid() ? typename Pose::Point(graph.poses[e.pose.index()] * e.lever_arm)
                          : graph.points[e.point.index()];
  };
  for (std::size_t i = 0; i + 3 < count; ++i) {
    const RangeEnd<Pose> point{{}, PointId(i % 2), Pose::Point::Zero()};
    RangeFactor<Pose> range{end_at(i), i % 3 == 0 ? end_at(i + 3) : point, 0, 0.2, {}, 1};
    range.range_m = (place(range.j) - place(range.i)).norm() + 0.1 * noise * draw.rng.normal();
    graph.ranges.push_back(range);
    BearingFactor<Pose> bearing{id(i), i % 2 == 0 ? end_at(i + 2) : point, {}, 0.1, {}, 1};
    const typename Pose::Point seen = graph.poses[i].inverse() * place(bearing.j);
    bearing.direction = (seen.normalized() + draw.point(0.05 * noise)).normalized();
    graph.bearings.push_back(bearing);
  }
  for (std::size_t i = 0; i < count; i += 4) {
    PositionFactor<Pose> position{end_at(i), {}, draw.template information<kDim>(), {}, 1};
    position.position = place(position.i) + draw.point(0.1 * noise);
    graph.positions.push_back(position);
  }
  PositionFactor<Pose> of_point{{{}, PointId(1), Pose::Point::Zero()}, graph.points[1], {}, {}, 1};
  of_point.information.setIdentity();
  graph.positions.push_back(of_point);
  graph.pose_priors.push_back(
      {id(count / 2), measured(graph.poses[count / 2]), draw.template information<kDof>(), {}, 0.5});
  graph.drift_priors.push_back({DriftId(0), graph.drifts[0], 100 * draw.template information<2>()});
  add_relative_points(graph, draw, noise);
  return graph;
}

/// Moves every pose but the first, every point and every drift.
template <class Pose>
void disturb(PoseGraph<Pose>& graph, std::uint64_t seed, double amount) {
  Drawing<Pose> draw(seed);
  for (std::size_t i = 1; i < graph.poses.size(); ++i)
    graph.poses[i] = graph.poses[i] * draw.pose(amount, amount);
  for (auto& point : graph.points) point += draw.point(amount);
  for (auto& drift : graph.drifts) drift += 0.1 * amount * draw.template normals<2>(1);
}

/// The largest difference of any pose, point or drift.
template <class Pose>
double largest_difference(const PoseGraph<Pose>& a, const PoseGraph<Pose>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.poses.size(); ++i)
    worst = std::max(worst, (a.poses[i].inverse() * b.poses[i]).log().norm());
  for (std::size_t i = 0; i < a.points.size(); ++i)
    worst = std::max(worst, (a.points[i] - b.points[i]).norm());
  for (std::size_t i = 0; i < a.drifts.size(); ++i)
    worst = std::max(worst, (a.drifts[i] - b.drifts[i]).norm());
  return worst;
}

using PoseTypes = testing::Types<SE2, SE3>;

}  // namespace radioslam::test
