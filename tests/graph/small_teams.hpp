// Small teams with loops between robots that pass over the same ground, in one frame or each in its own.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>

#include "graph/random_graphs.hpp"
#include "radioslam/graph/chordal.hpp"
#include "radioslam/graph/distributed/distributed_solver.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam::test {

/// A team's graph, and whose pose is which.
template <class Pose>
struct SmallTeam {
  PoseGraph<Pose> graph;
  TeamPoses poses;
};

/// Pairs of robots that have loops between them, the lower one first.
using Meetings = std::vector<std::pair<std::size_t, std::size_t>>;
inline Meetings chain_of(std::size_t robots) {
  Meetings meetings;
  for (std::size_t r = 0; r + 1 < robots; ++r) meetings.emplace_back(r, r + 1);
  return meetings;
}
inline Meetings ring_of(std::size_t robots) {
  Meetings meetings = chain_of(robots);
  meetings.emplace_back(0, robots - 1);
  return meetings;
}
inline Meetings all_of(std::size_t robots) {
  Meetings meetings;
  for (std::size_t a = 0; a < robots; ++a)
    for (std::size_t b = a + 1; b < robots; ++b) meetings.emplace_back(a, b);
  return meetings;
}
inline Meetings grid_of(std::size_t side) {
  Meetings meetings;
  for (std::size_t r = 0; r < side * side; ++r) {
    if (r % side + 1 < side) meetings.emplace_back(r, r + 1);
    if (r / side + 1 < side) meetings.emplace_back(r, r + side);
  }
  return meetings;
}

/// `robots` robots walk `steps` steps of two metres along x, on lines three metres apart. Odometry between
/// poses that follow each other, and loops at every `every`-th pose between robots that meet. Values are
/// odometry's, every robot in a frame of its own.
template <class Pose>
SmallTeam<Pose> draw_team(std::uint64_t seed, std::size_t robots, std::size_t steps, double noise,
                          const Meetings& meetings, std::size_t every = 3) {
  Drawing<Pose> draw(seed);
  SmallTeam<Pose> team;
  PoseGraph<Pose>& graph = team.graph;
  std::vector<RobotNumber> robot_of;
  for (std::size_t r = 0; r < robots; ++r)
    for (std::size_t k = 0; k < steps; ++k) {
      typename Pose::Tangent place = Pose::Tangent::Zero();
      place[0] = 2.0 * static_cast<double>(k);
      place[1] = 3.0 * static_cast<double>(r);
      graph.poses.push_back(Pose::exp(place) * draw.pose(0.2, 0.3));
      robot_of.push_back(static_cast<RobotNumber>(r));
    }
  const auto measure = [&](std::size_t i, std::size_t j) {
    RelativePoseFactor<Pose> f;
    f.i = PoseId(i);
    f.j = PoseId(j);
    f.T_i_j = graph.poses[i].inverse() * graph.poses[j] * draw.pose(0.1 * noise, 0.05 * noise);
    f.information.diagonal().setConstant(100);
    f.information.diagonal().template tail<Pose::kDof - Pose::kDim>().setConstant(400);
    graph.relative_poses.push_back(f);
  };
  for (std::size_t r = 0; r < robots; ++r)
    for (std::size_t k = 0; k < steps; ++k) {
      if (k + 1 < steps) measure(r * steps + k, r * steps + k + 1);
      if (k % every != 0) continue;
      for (const auto& [a, b] : meetings)
        if (a == r) measure(r * steps + k, b * steps + k);
    }
  for (std::size_t r = 0; r < robots; ++r) {
    graph.poses[r * steps] = draw.pose(5, 2);
    for (std::size_t k = 0; k + 1 < steps; ++k) {
      const std::size_t p = r * steps + k;
      for (const auto& f : graph.relative_poses)
        if (f.i.index() == p && f.j.index() == p + 1) graph.poses[p + 1] = graph.poses[p] * f.T_i_j;
    }
  }
  team.poses = team_poses(robot_of, robots);
  return team;
}

/// Every robot meets the next one.
template <class Pose>
SmallTeam<Pose> draw_team(std::uint64_t seed, std::size_t robots, std::size_t steps, double noise) {
  return draw_team<Pose>(seed, robots, steps, noise, chain_of(robots));
}

/// Some robots of a team, as if there were no others. They keep their order.
template <class Pose>
SmallTeam<Pose> only(const SmallTeam<Pose>& team, const std::vector<RobotNumber>& robots) {
  SmallTeam<Pose> part;
  std::vector<RobotNumber> robot_of;
  std::map<std::size_t, std::size_t> place;
  for (std::size_t r = 0; r < robots.size(); ++r)
    for (const std::size_t p : team.poses.poses[robots[r]]) {
      place[p] = part.graph.poses.size();
      part.graph.poses.push_back(team.graph.poses[p]);
      robot_of.push_back(static_cast<RobotNumber>(r));
    }
  for (auto f : team.graph.relative_poses) {
    if (!place.contains(f.i.index()) || !place.contains(f.j.index())) continue;
    f.i = PoseId(place[f.i.index()]);
    f.j = PoseId(place[f.j.index()]);
    part.graph.relative_poses.push_back(f);
  }
  part.poses = team_poses(robot_of, robots.size());
  return part;
}

/// Two teams that do not know of each other.
template <class Pose>
SmallTeam<Pose> side_by_side(const SmallTeam<Pose>& a, const SmallTeam<Pose>& b) {
  SmallTeam<Pose> both = a;
  const std::size_t poses = a.graph.poses.size();
  both.graph.poses.insert(both.graph.poses.end(), b.graph.poses.begin(), b.graph.poses.end());
  for (auto f : b.graph.relative_poses) {
    f.i = PoseId(f.i.index() + poses);
    f.j = PoseId(f.j.index() + poses);
    both.graph.relative_poses.push_back(f);
  }
  auto robot_of = a.poses.robot_of;
  const auto robots = static_cast<RobotNumber>(a.poses.poses.size());
  for (const RobotNumber r : b.poses.robot_of) robot_of.push_back(robots + r);
  both.poses = team_poses(robot_of, a.poses.poses.size() + b.poses.poses.size());
  return both;
}

/// Without the odometry after pose `k` of a robot: only other robots tie its two parts.
template <class Pose>
SmallTeam<Pose> cut(SmallTeam<Pose> team, RobotNumber robot, std::size_t k) {
  const std::size_t i = team.poses.poses[robot][k], j = team.poses.poses[robot][k + 1];
  std::erase_if(team.graph.relative_poses,
                [&](const auto& f) { return f.i.index() == i && f.j.index() == j; });
  return team;
}

/// What both stages give when one computer has everything.
template <class Pose>
double central_optimum(PoseGraph<Pose> graph) {
  initialise_chordal(graph);
  return optimize(graph, OptimizerParams{}).final_cost;
}

/// Runs a team's solvers and calls body(robot's graph, solver, message) for every message.
template <class Pose, class MakeSolver, class Body>
void for_each_message(const SmallTeam<Pose>& team, int rounds, const MakeSolver& make_solver, Body&& body) {
  const auto robots = split_by_robot(team.graph, team.poses);
  std::vector<std::unique_ptr<DistributedSolver<Pose>>> solvers;
  for (const auto& robot : robots) solvers.push_back(make_solver(robot));
  std::vector<std::vector<Message<Pose>>> inbox(robots.size());
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::vector<Message<Pose>>> next(robots.size());
    for (std::size_t r = 0; r < robots.size(); ++r) {
      std::set<RobotNumber> receivers;
      for (auto& message : solvers[r]->round(inbox[r])) {
        EXPECT_TRUE(receivers.insert(message.to).second) << "two messages in a round";
        body(robots[r], *solvers[r], message);
        next[message.to].push_back(std::move(message));
      }
    }
    inbox = std::move(next);
  }
  for (const auto& solver : solvers) EXPECT_EQ(solver->refused(), 0u);
}

/// A message is about the poses that the receiver has factors with, in their order, at the sender's values.
template <class Pose>
void expect_about_poses_seen(const RobotGraph<Pose>& robot, const DistributedSolver<Pose>& solver,
                             const Message<Pose>& message) {
  const std::size_t n = neighbour_index(robot, message.to);
  ASSERT_LT(n, robot.neighbours.size());
  const auto& seen = robot.neighbours[n].seen;
  EXPECT_TRUE(message.matrices.empty() || message.matrices.size() == seen.size());
  EXPECT_TRUE(message.steps.empty() || message.steps.size() == seen.size());
  EXPECT_FALSE(message.up || message.down);
  if (!message.seen) return;
  ASSERT_EQ(message.seen->poses.size(), seen.size());
  const auto poses = solver.poses();
  for (std::size_t k = 0; k < seen.size(); ++k)
    EXPECT_LT((message.seen->poses[k].inverse() * poses[seen[k]]).log().norm(), 1e-12);
}

}  // namespace radioslam::test
