// Three robots in a lattice of streets whose loops are uneven: much of the way is held by a handful of them,
// and wrong ones come in groups that agree with one another.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/joint/closures/loop_stage.hpp"
#include "radioslam/joint/joint_graph_from_file.hpp"

namespace radioslam {

struct LoopTeamParams {
  std::size_t robots = 3, poses = 500;
  double false_share = 0.15;
  double odometry_noise = 1.3;  ///< actual over stated
};

class LoopTeam {
 public:
  static constexpr double kSigmaStep_m = 0.05, kSigmaStep_rad = 0.015, kSigmaLoop_m = 0.1,
                          kSigmaLoop_rad = 0.02;

  explicit LoopTeam(std::uint64_t seed, const LoopTeamParams& params = {}) : params_(params), rng_(seed) {
    team.graph.chart = PoseChart::kLogarithm;
    for (std::size_t r = 0; r < params.robots; ++r) add_robot(r);
    add_true_loops();
    add_false_loops();
    team.graph.relative_poses.insert(team.graph.relative_poses.end(), loops.begin(), loops.end());
  }

  TeamGraph<SE2> team;
  Mission mission;
  std::vector<SE2> truth;                      ///< per pose of the graph
  std::vector<RelativePoseFactor<SE2>> loops;  ///< the last of the graph's relative poses
  std::vector<bool> is_true;                   ///< per loop

 private:
  static constexpr double kBlock_m = 30, kMeeting_m = 3;
  static constexpr std::size_t kStretch = 60, kApart = 30;

  static SE2::Jacobian information(double sigma_m, double sigma_rad) {
    return Eigen::Vector3d(1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad))
        .asDiagonal();
  }

  SE2 disturbed(const SE2& pose, double sigma_m, double sigma_rad) {
    return pose * SE2::exp({sigma_m * rng_.normal(), sigma_m * rng_.normal(), sigma_rad * rng_.normal()});
  }

  std::size_t below(std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(rng_.uniform(0, static_cast<double>(count))));
  }

  /// Along streets, 1 m a pose, with a turn or none at every crossing.
  std::vector<SE2> walk() {
    const auto steps = static_cast<std::size_t>(kBlock_m);
    int x = static_cast<int>(below(4)), y = static_cast<int>(below(4)), heading = static_cast<int>(below(4));
    std::vector<SE2> poses;
    while (poses.size() < params_.poses) {
      const int turn = static_cast<int>(below(3)) - 1;
      heading = (heading + turn + 4) % 4;
      const int dx = heading == 0 ? 1 : heading == 2 ? -1 : 0, dy = heading == 1 ? 1 : heading == 3 ? -1 : 0;
      if (x + dx < 0 || x + dx > 3 || y + dy < 0 || y + dy > 3) continue;
      const double angle = heading * std::numbers::pi / 2;
      for (std::size_t k = 0; k < steps && poses.size() < params_.poses; ++k)
        poses.emplace_back(Eigen::Vector2d(x * kBlock_m + dx * static_cast<double>(k),
                                           y * kBlock_m + dy * static_cast<double>(k)),
                           angle);
      x += dx, y += dy;
    }
    return poses;
  }

  void add_robot(std::size_t r) {
    const std::vector<SE2> poses = walk();
    TrajectorySegment segment;
    segment.robot = std::string(1, static_cast<char>('a' + r));
    segment.first_pose = team.graph.poses.size();
    segment.pose_count = poses.size();
    mission.robots.emplace_back().id = segment.robot;
    SE2 reckoned;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      segment.stamps.push_back({static_cast<std::int64_t>(k) * kNanosecondsPerSecond});
      if (k > 0) {
        RelativePoseFactor<SE2> step;
        step.i = PoseId(segment.first_pose + k - 1);
        step.j = PoseId(segment.first_pose + k);
        step.T_i_j = disturbed(poses[k - 1].inverse() * poses[k], params_.odometry_noise * kSigmaStep_m,
                               params_.odometry_noise * kSigmaStep_rad);
        step.information = information(kSigmaStep_m, kSigmaStep_rad);
        team.graph.relative_poses.push_back(step);
        reckoned = reckoned * step.T_i_j;
      }
      team.graph.poses.push_back(reckoned);
      truth.push_back(poses[k]);
    }
    team.segments.push_back(segment);
  }

  void add(std::size_t i, std::size_t j, const SE2& T_i_j, bool is_right) {
    RelativePoseFactor<SE2> loop;
    loop.i = PoseId(i);
    loop.j = PoseId(j);
    loop.T_i_j = disturbed(T_i_j, kSigmaLoop_m, kSigmaLoop_rad);
    loop.information = information(kSigmaLoop_m, kSigmaLoop_rad);
    loops.push_back(loop);
    is_true.push_back(is_right);
  }

  void add_true_loops() {
    std::vector<double> share;
    for (std::size_t k = 0; k <= truth.size() / kStretch; ++k)
      share.push_back(rng_.uniform(0, 1) < 0.4 ? 0.01 : 0.15);
    for (std::size_t i = 0; i < truth.size(); ++i)
      for (std::size_t j = i + 1; j < truth.size(); ++j) {
        if (i / params_.poses == j / params_.poses && j - i < kApart) continue;
        if ((truth[i].translation() - truth[j].translation()).norm() > kMeeting_m) continue;
        if (rng_.uniform(0, 1) < share[i / kStretch] * share[j / kStretch] * 4)
          add(i, j, truth[i].inverse() * truth[j], true);
      }
  }

  /// Stretches that look like others elsewhere.
  void add_false_loops() {
    const auto wanted = static_cast<std::size_t>(static_cast<double>(loops.size()) * params_.false_share /
                                                 (1 - params_.false_share));
    std::size_t added = 0;
    while (added < wanted) {
      const std::size_t count = std::min(wanted - added, 4 + below(17));
      const std::size_t i = below(truth.size()), j = below(truth.size());
      const auto of = [&](std::size_t k) { return k / params_.poses; };
      if (of(i + count) != of(i) || of(j + count) != of(j) || i + count > truth.size() ||
          j + count > truth.size())
        continue;
      if ((truth[i].translation() - truth[j].translation()).norm() < 10) continue;
      const SE2 shift = truth[i] * truth[j].inverse();
      for (std::size_t k = 0; k < count; ++k)
        add(i + k, j + k, truth[i + k].inverse() * shift * truth[j + k], false);
      added += count;
    }
  }

  LoopTeamParams params_;
  Rng rng_;
};

}  // namespace radioslam
