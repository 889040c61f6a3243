// Robots that drive round the same block, with measured relative poses within and between them, some wrong.
#pragma once

#include <algorithm>
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

inline constexpr double kSigmaStep_m = 0.03, kSigmaStep_rad = 0.004;
inline constexpr double kSigmaLoop_m = 0.1, kSigmaLoop_rad = 0.02;

inline SE2::Jacobian planar_covariance(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
}

/// Robots that drive round the same block, 30 m by 50 m, each from its own corner and in its own frame, a
/// pose a metre.
class BlockTeam {
 public:
  static constexpr std::size_t kRound = 160;  // poses

  explicit BlockTeam(std::size_t robots, std::size_t poses = 200) {
    team_.graph.chart = PoseChart::kLogarithm;
    for (std::size_t r = 0; r < robots; ++r) add_robot(r, poses);
  }

  /// A true measurement of pose `j` of robot `s` from pose `i` of robot `r`, of `scale` times the stated
  /// noise.
  void see(std::size_t r, std::size_t i, std::size_t s, std::size_t j, double scale = 1) {
    add(r, i, s, j,
        disturbed(truth_[r][i].inverse() * truth_[s][j], scale * kSigmaLoop_m, scale * kSigmaLoop_rad));
  }

  /// A wrong one, which agrees with others of the same `shift` between the robots' frames.
  void mistake(std::size_t r, std::size_t i, std::size_t s, std::size_t j, const SE2& shift) {
    add(r, i, s, j, disturbed(truth_[r][i].inverse() * shift * truth_[s][j], kSigmaLoop_m, kSigmaLoop_rad));
  }

  void repeat_last(std::size_t times) {
    const RelativePoseFactor<SE2> last = loops_.back();
    loops_.insert(loops_.end(), times, last);
  }

  struct Outcome {
    JointGraph<SE2> joint;
    TeamAlignment<SE2> alignment;
    std::vector<Closure> closures;
    std::vector<ClosureJudgement> judgements;
  };

  /// Every robot in its own frame, with the measurements that the others may join by.
  Outcome measured() const {
    TeamGraph<SE2> team = team_;
    team.graph.relative_poses.insert(team.graph.relative_poses.end(), loops_.begin(), loops_.end());
    Outcome out{joint_graph_of(team, mission_), {}, {}, {}};
    out.closures = closures_of(team, out.joint);
    out.judgements.resize(out.closures.size());
    for (std::size_t r = 0; r < truth_.size(); ++r) {
      out.alignment.component.push_back(static_cast<int>(r));
      out.alignment.placed.push_back(r == 0);
      out.alignment.absolute.push_back(false);
      out.alignment.in_common_frame.push_back(false);
    }
    out.alignment.without_matches = out.alignment.of_segment = out.alignment.component;
    return out;
  }

  Outcome solve(const ConsistencyParams& consistency = {}) const {
    Outcome out = measured();
    add_own_loops(out.joint, out.closures, {});
    close_by_loops(out.joint, out.alignment, out.closures, out.judgements, {.consistency = consistency}, {},
                   {});
    return out;
  }

  /// Largest position error of robots r and s together, in the frame of robot r's first pose.
  double largest_error_m(const Outcome& out, std::size_t r, std::size_t s) const {
    double largest = 0;
    for (const std::size_t of : {r, s})
      for (std::size_t k = 0; k < truth_[of].size(); ++k) {
        const SE2 estimated = pose(out, r, 0).inverse() * pose(out, of, k),
                  actual = truth_[r][0].inverse() * truth_[of][k];
        largest = std::max(largest, (estimated.translation() - actual.translation()).norm());
      }
    return largest;
  }

  /// Error of where robot r, from its pose i, sees pose j of robot s.
  double relative_error_m(const Outcome& out, std::size_t r, std::size_t i, std::size_t s,
                          std::size_t j) const {
    const SE2 estimated = pose(out, r, i).inverse() * pose(out, s, j);
    return (estimated.translation() - (truth_[r][i].inverse() * truth_[s][j]).translation()).norm();
  }

  const SE2& pose(const Outcome& out, std::size_t r, std::size_t k) const {
    return out.joint.team.graph.poses[team_.segments[r].first_pose + k];
  }

 private:
  void add_robot(std::size_t r, std::size_t poses) {
    std::vector<SE2> walk;
    for (std::size_t k = 0; k < poses; ++k) walk.push_back(along(k + r * 40));
    TrajectorySegment segment;
    segment.robot = std::string(1, static_cast<char>('a' + r));
    segment.first_pose = team_.graph.poses.size();
    segment.pose_count = poses;
    Robot& robot = mission_.robots.emplace_back();
    robot.id = segment.robot;
    SE2 reckoned;
    for (std::size_t k = 0; k < poses; ++k) {
      segment.stamps.push_back({static_cast<std::int64_t>(k) * kNanosecondsPerSecond});
      if (k > 0) {
        RelativePoseFactor<SE2> step;
        step.i = PoseId(segment.first_pose + k - 1);
        step.j = PoseId(segment.first_pose + k);
        step.T_i_j = disturbed(walk[k - 1].inverse() * walk[k], kSigmaStep_m, kSigmaStep_rad);
        step.information = inverse(planar_covariance(kSigmaStep_m, kSigmaStep_rad));
        team_.graph.relative_poses.push_back(step);
        reckoned = reckoned * step.T_i_j;
      }
      team_.graph.poses.push_back(reckoned);
    }
    team_.segments.push_back(segment);
    truth_.push_back(std::move(walk));
  }

  /// The pose `k` metres along the block, anticlockwise.
  static SE2 along(std::size_t k) {
    const double at = static_cast<double>(k % kRound), right = std::numbers::pi / 2;
    if (at < 50) return SE2({at, 0}, 0);
    if (at < 80) return SE2({50, at - 50}, right);
    if (at < 130) return SE2({130 - at, 30}, 2 * right);
    return SE2({0, 160 - at}, 3 * right);
  }

  SE2 disturbed(const SE2& pose, double sigma_m, double sigma_rad) {
    return pose * SE2::exp({sigma_m * rng_.normal(), sigma_m * rng_.normal(), sigma_rad * rng_.normal()});
  }

  void add(std::size_t r, std::size_t i, std::size_t s, std::size_t j, const SE2& T_i_j) {
    RelativePoseFactor<SE2> loop;
    loop.i = PoseId(team_.segments[r].first_pose + i);
    loop.j = PoseId(team_.segments[s].first_pose + j);
    loop.T_i_j = T_i_j;
    loop.information = inverse(planar_covariance(kSigmaLoop_m, kSigmaLoop_rad));
    loops_.push_back(loop);
  }

  Rng rng_{7};
  std::vector<std::vector<SE2>> truth_;
  TeamGraph<SE2> team_;
  Mission mission_;
  std::vector<RelativePoseFactor<SE2>> loops_;
};

}  // namespace radioslam
