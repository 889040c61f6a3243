// Simulator for the alignment tests: teams that drive along a street grid and measure ranges and angles to
// each other, with ground truth and labels of the direct paths.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/graph/team_graph.hpp"

namespace radioslam::test {

struct RadioWorld {
  int robots = 2;
  double route_m = 1700;
  double block_m = 80;
  int blocks = 6;  ///< side of the square that contains the trajectories
  double radio_reach_m = 100;
  int links = 40;  ///< per pair of robots
  bool ranges = true;
  double sigma_range_m = 0.5;
  int angle_ends = 2;  ///< 0, 1 (received by the first of the pair) or 2
  double sigma_angle_rad = 10 * std::numbers::pi / 180;
  int most_false_paths = 5;
  double missing_direct_ratio = 0.15;
  bool mirror = false;        ///< every angle has a reflection at a wall along the street
  int angle_delay_poses = 0;  ///< the angles are measured this many poses after the range
  double stated_noise = 1;    ///< ratio of stated to true odometry noise
  bool corners = false;       ///< radio follows the streets: out of a street only round its corners
};

struct SimulatedTeam {
  TeamGraph<SE2> team;           ///< values: dead reckoning, every robot from the identity
  std::vector<SE2> truth;        ///< of every pose
  std::vector<int> direct_path;  ///< of every bearing; -1: none
  std::vector<bool> in_sight;    ///< of every range
};

class RadioWorldSimulator {
 public:
  RadioWorldSimulator(const RadioWorld& world, std::uint64_t seed) : world_(world), rng_(seed) {}

  /// Smallest number of poses at which any two robots were within range.
  std::size_t shortest_encounter() const { return shortest_encounter_; }

  SimulatedTeam run() {
    for (int r = 0; r < world_.robots; ++r) drive(r);
    for (int a = 0; a < world_.robots; ++a)
      for (int b = a + 1; b < world_.robots; ++b) link(a, b);
    return std::move(result_);
  }

 private:
  static constexpr double kStep_m = 2, kPerRootM = 0.02, kYawPerRootM = 0.002, kYawPerRad = 0.01;

  SE2 noisy(const SE2& step, double distance, double turn) {
    SE2::Tangent error;
    error << rng_.normal(0, kPerRootM * std::sqrt(distance)), rng_.normal(0, kPerRootM * std::sqrt(distance)),
        rng_.normal(0, std::sqrt(kYawPerRootM * kYawPerRootM * distance + kYawPerRad * kYawPerRad * turn));
    return step * SE2::exp(error);
  }

  void add_step(const SE2& T, double distance, double turn) {
    auto& graph = result_.team.graph;
    RelativePoseFactor<SE2> factor;
    factor.i = PoseId(graph.poses.size() - 1);
    factor.j = PoseId(graph.poses.size());
    factor.T_i_j = noisy(T, distance, turn);
    const double s2 = world_.stated_noise * world_.stated_noise;
    Eigen::Vector3d variance;
    variance << kPerRootM * kPerRootM * distance + 1e-6, kPerRootM * kPerRootM * distance + 1e-6,
        kYawPerRootM * kYawPerRootM * distance + kYawPerRad * kYawPerRad * turn + 1e-8;
    factor.information = (s2 * variance).cwiseInverse().asDiagonal();
    graph.relative_poses.push_back(factor);
    result_.truth.push_back(result_.truth.back() * T);
    graph.poses.push_back(graph.poses.back() * factor.T_i_j);
    auto& segment = result_.team.segments.back();
    ++segment.pose_count;
    segment.stamps.push_back(Stamp{static_cast<std::int64_t>(segment.pose_count) * 250000000});
  }

  void drive(int robot) {
    auto& graph = result_.team.graph;
    TrajectorySegment segment{"r" + std::to_string(robot), graph.poses.size(), 1, {Stamp{0}}};
    result_.team.segments.push_back(segment);
    const double quarter = std::numbers::pi / 2;
    // Each number is drawn in its own statement: the evaluation order of arguments is unspecified.
    const double heading = quarter * static_cast<double>(rng_.below(4));
    const double x =
        world_.block_m * static_cast<double>(rng_.below(static_cast<std::uint64_t>(world_.blocks)));
    const double y =
        world_.block_m * static_cast<double>(rng_.below(static_cast<std::uint64_t>(world_.blocks)));
    const SE2 start({x, y}, heading);
    result_.truth.push_back(start);
    graph.poses.push_back(SE2());
    const int steps_per_block = static_cast<int>(world_.block_m / kStep_m);
    for (double driven = 0; driven < world_.route_m; driven += world_.block_m) {
      for (int k = 0; k < steps_per_block; ++k) add_step(SE2({kStep_m, 0}, 0), kStep_m, 0);
      turn_at_crossing();
    }
  }

  void turn_at_crossing() {
    const double quarter = std::numbers::pi / 2;
    std::vector<double> open;
    for (const double turn : {0.0, quarter, -quarter}) {
      const SE2 next = result_.truth.back() * SE2({0, 0}, turn) * SE2({world_.block_m, 0}, 0);
      const Eigen::Vector2d p = next.translation();
      const double edge = world_.block_m * world_.blocks + 1;
      if (p.minCoeff() > -1 && p.maxCoeff() < edge) open.push_back(turn);
    }
    const double turn = open.empty() ? std::numbers::pi : open[rng_.below(open.size())];
    if (turn != 0) add_step(SE2({0, 0}, turn), 0, std::abs(turn));
  }

  void link(int a, int b) {
    const TrajectorySegment& pa = result_.team.segments[static_cast<std::size_t>(a)];
    const TrajectorySegment& pb = result_.team.segments[static_cast<std::size_t>(b)];
    const std::size_t count =
        std::min(pa.pose_count, pb.pose_count) - static_cast<std::size_t>(world_.angle_delay_poses);
    std::vector<std::size_t> near;
    for (std::size_t k = 0; k < count; ++k)
      if ((result_.truth[pa.first_pose + k].translation() - result_.truth[pb.first_pose + k].translation())
              .norm() < world_.radio_reach_m)
        near.push_back(k);
    shortest_encounter_ = std::min(shortest_encounter_, near.size());
    for (int n = 0; n < world_.links && !near.empty(); ++n) {
      const std::size_t k = near[rng_.below(near.size())];
      if (world_.ranges) add_range(pa.first_pose + k, pb.first_pose + k);
      const auto later = k + static_cast<std::size_t>(world_.angle_delay_poses);
      if (world_.angle_ends >= 1) add_bearing(pa.first_pose + later, pb.first_pose + later);
      if (world_.angle_ends == 2) add_bearing(pb.first_pose + later, pa.first_pose + later);
    }
  }

  /// The way of a signal, and the first point on it: the other end, or a corner.
  struct Route {
    double length_m;
    Eigen::Vector2d first;
    bool in_sight;
  };

  /// A street: axis, and the coordinate across it.
  std::vector<std::pair<int, double>> streets_at(const Eigen::Vector2d& place) const {
    std::vector<std::pair<int, double>> streets;
    for (int axis = 0; axis < 2; ++axis) {
      const double nearest = world_.block_m * std::round(place[axis] / world_.block_m);
      if (std::abs(place[axis] - nearest) < kStep_m / 2) streets.emplace_back(axis, nearest);
    }
    return streets;
  }

  Route route(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    const Route direct{(to - from).norm(), to, true};
    if (!world_.corners) return direct;
    Route best{std::numeric_limits<double>::infinity(), to, false};
    for (const auto& [axis, across] : streets_at(from))
      for (const auto& [other_axis, other_across] : streets_at(to)) {
        if (axis == other_axis && across == other_across) return direct;
        for (int k = 0; k <= world_.blocks; ++k) {  // crossing streets by which parallel ones are connected
          Eigen::Vector2d first, last;
          first[axis] = across;
          last[other_axis] = other_across;
          first[1 - axis] = axis == other_axis ? world_.block_m * k : other_across;
          last[1 - other_axis] = axis == other_axis ? world_.block_m * k : across;
          const double length_m = (first - from).norm() + (last - first).norm() + (to - last).norm();
          if (length_m < best.length_m) best = {length_m, first, false};
        }
      }
    return best;
  }

  void add_range(std::size_t i, std::size_t j) {
    const Route route = this->route(result_.truth[i].translation(), result_.truth[j].translation());
    RangeFactor<SE2> range;
    range.i.pose = PoseId(i);
    range.j.pose = PoseId(j);
    range.range_m = std::abs(route.length_m + rng_.normal(0, world_.sigma_range_m));
    range.sigma_m = world_.sigma_range_m;
    result_.team.graph.ranges.push_back(range);
    result_.in_sight.push_back(route.in_sight);
  }

  BearingPath<SE2> path(double azimuth, double power_db) {
    return {{std::cos(azimuth), std::sin(azimuth)}, world_.sigma_angle_rad, power_db};
  }

  void add_bearing(std::size_t i, std::size_t j) {
    AmbiguousBearing<SE2> bearing;
    bearing.i = PoseId(i);
    bearing.j.pose = PoseId(j);
    const Route route = this->route(result_.truth[i].translation(), result_.truth[j].translation());
    const Eigen::Vector2d seen = result_.truth[i].inverse() * route.first;
    const double direct = std::atan2(seen.y(), seen.x());
    int direct_index = -1;
    if (rng_.uniform() >= world_.missing_direct_ratio) {
      direct_index = route.in_sight ? 0 : -1;
      const double power_db = rng_.normal(-50, 6);
      bearing.paths.push_back(path(direct + rng_.normal(0, world_.sigma_angle_rad), power_db));
    }
    if (world_.mirror) {  // a wall beside the street, parallel to the receiver's heading
      const double power_db = rng_.normal(-53, 6);
      bearing.paths.push_back(path(-direct + rng_.normal(0, world_.sigma_angle_rad), power_db));
    }
    const int extra = static_cast<int>(rng_.below(static_cast<std::uint64_t>(world_.most_false_paths) + 1));
    for (int k = 0; k < extra; ++k) {
      const double power_db = rng_.normal(-55, 6);
      bearing.paths.push_back(path(rng_.uniform(-std::numbers::pi, std::numbers::pi), power_db));
    }
    if (bearing.paths.empty()) bearing.paths.push_back(path(rng_.uniform(-3, 3), -60));
    result_.team.bearings.push_back(bearing);
    result_.direct_path.push_back(direct_index);
  }

  RadioWorld world_;
  Rng rng_;
  SimulatedTeam result_;
  std::size_t shortest_encounter_ = 1000000;
};

/// Redraws until all pairs of robots were within range for a while.
inline SimulatedTeam simulate_team(const RadioWorld& world, std::uint64_t seed) {
  for (std::uint64_t draw = 0;; ++draw) {
    RadioWorldSimulator simulator(world, Rng(seed).split(draw).next());
    SimulatedTeam result = simulator.run();
    if (simulator.shortest_encounter() >= 60) return result;
  }
}

}  // namespace radioslam::test
