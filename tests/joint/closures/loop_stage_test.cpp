#include "radioslam/joint/closures/loop_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "radioslam/base/random.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/joint/joint_graph_from_file.hpp"

namespace radioslam {
namespace {

constexpr double kSigmaStep_m = 0.03, kSigmaStep_rad = 0.004;
constexpr double kSigmaLoop_m = 0.1, kSigmaLoop_rad = 0.02;

SE2::Jacobian covariance(double sigma_m, double sigma_rad) {
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
    TeamPlacement<SE2> placement;
    std::vector<Closure> closures;
  };

  Outcome solve() {
    TeamGraph<SE2> team = team_;
    team.graph.relative_poses.insert(team.graph.relative_poses.end(), loops_.begin(), loops_.end());
    Outcome out{joint_graph_of(team, mission_), {}, {}};
    out.closures = closures_of(team, out.joint);
    add_own_loops(out.joint, out.closures, {});
    for (std::size_t r = 0; r < truth_.size(); ++r) {
      out.placement.component.push_back(static_cast<int>(r));
      out.placement.placed.push_back(r == 0);
      out.placement.absolute.push_back(false);
    }
    close_by_loops(out.joint, out.placement, out.closures, {}, {});
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
        step.information = inverse(covariance(kSigmaStep_m, kSigmaStep_rad));
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
    loop.information = inverse(covariance(kSigmaLoop_m, kSigmaLoop_rad));
    loops_.push_back(loop);
  }

  Rng rng_{7};
  std::vector<std::vector<SE2>> truth_;
  TeamGraph<SE2> team_;
  Mission mission_;
  std::vector<RelativePoseFactor<SE2>> loops_;
};

std::size_t accepted(const BlockTeam::Outcome& out, std::size_t begin, std::size_t end) {
  return static_cast<std::size_t>(
      std::count_if(out.closures.begin() + static_cast<std::ptrdiff_t>(begin),
                    out.closures.begin() + static_cast<std::ptrdiff_t>(end),
                    [](const Closure& c) { return c.status == ClosureStatus::kAccepted; }));
}

const SE2 kElsewhere({20, -35}, 0.8);

TEST(CloseByLoops, AlignsTwoRobotsAndRejectsWhatContradicts) {
  BlockTeam team(2);
  for (std::size_t k = 40; k < 160; k += 20) team.see(0, k, 1, k - 40);
  for (std::size_t k = 0; k < 3; ++k) team.mistake(0, 20 + 7 * k, 1, 90 - k, kElsewhere);
  const auto out = team.solve();
  EXPECT_EQ(out.placement.component, (std::vector<int>{0, 0}));
  EXPECT_TRUE(out.placement.placed[1]);
  EXPECT_EQ(accepted(out, 0, 6), 6u);
  EXPECT_EQ(accepted(out, 6, 9), 0u);
  for (std::size_t k = 40; k < 160; k += 10) EXPECT_LT(team.relative_error_m(out, 0, k, 1, k - 40), 0.7);
}

TEST(CloseByLoops, CountsRepetitionsOfAMeasurementOnce) {
  BlockTeam once(2);
  for (std::size_t k = 40; k < 160; k += 20) once.see(0, k, 1, k - 40);
  BlockTeam often = once;
  often.repeat_last(219);
  const auto one = once.solve(), many = often.solve();
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t k = 0; k < 200; ++k)
      EXPECT_LT((once.pose(one, r, k).inverse() * often.pose(many, r, k)).log().norm(), 1e-9);
  EXPECT_EQ(accepted(many, 0, many.closures.size()), many.closures.size());
}

TEST(CloseByLoops, RepetitionsAloneDoNotPlaceARobot) {
  BlockTeam team(2);
  team.see(0, 100, 1, 60);
  team.repeat_last(219);
  const auto out = team.solve();
  EXPECT_EQ(out.placement.component, (std::vector<int>{0, 1}));
  EXPECT_FALSE(out.placement.placed[1]);
  EXPECT_EQ(accepted(out, 0, out.closures.size()), 0u);
  EXPECT_EQ(out.closures.front().reason, "no group of loops stands out");
}

TEST(CloseByLoops, CorrectsTrajectoriesByTheirOwnLoops) {
  BlockTeam apart(1, 320), looped(1, 320);
  for (std::size_t k = 0; k < 160; k += 16) looped.see(0, k, 0, k + BlockTeam::kRound);
  for (std::size_t k = 0; k < 4; ++k) looped.mistake(0, 10 + 9 * k, 0, 90 - k, kElsewhere);
  const auto out = looped.solve();
  EXPECT_EQ(accepted(out, 0, 10), 10u);
  EXPECT_EQ(accepted(out, 10, 14), 0u);
  EXPECT_LT(looped.largest_error_m(out, 0, 0), 0.6 * apart.largest_error_m(apart.solve(), 0, 0));
}

TEST(CloseByLoops, LeavesRobotsApartWhereGroupsAreEquallyStrong) {
  BlockTeam team(2);
  for (const std::size_t k : {40u, 100u}) team.see(0, k, 1, k - 40);
  for (const std::size_t k : {60u, 130u}) team.mistake(0, k, 1, k - 40, kElsewhere);
  const auto out = team.solve();
  EXPECT_EQ(out.placement.component, (std::vector<int>{0, 1}));
  EXPECT_EQ(accepted(out, 0, 4), 0u);
}

TEST(CloseByLoops, ACycleOfThreeRobotsDecidesBetweenGroups) {
  BlockTeam team(3);
  for (const std::size_t k : {45u, 100u}) team.see(0, k, 1, k - 40);
  for (const std::size_t k : {60u, 90u, 130u}) team.mistake(0, k, 1, k - 40, kElsewhere);
  for (const std::size_t k : {85u, 120u, 160u}) team.see(0, k, 2, k - 80);
  for (const std::size_t k : {50u, 90u, 140u}) team.see(1, k, 2, k - 40);
  const auto out = team.solve();
  EXPECT_EQ(out.placement.component, (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(accepted(out, 0, 2), 2u);
  EXPECT_EQ(accepted(out, 2, 5), 0u);
  EXPECT_EQ(accepted(out, 5, 11), 6u);
  for (const std::size_t k : {45u, 100u}) EXPECT_LT(team.relative_error_m(out, 0, k, 1, k - 40), 0.7);
}

TEST(CloseByLoops, KeepsTrueLoopsWhoseCovariancesAreTooSmallAndSaysSo) {
  BlockTeam team(2);
  for (std::size_t k = 40; k < 199; k += 3) team.see(0, k, 1, k - 40, 3);
  const auto out = team.solve();
  EXPECT_EQ(out.placement.component, (std::vector<int>{0, 0}));
  EXPECT_GE(accepted(out, 0, out.closures.size()), out.closures.size() * 95 / 100);
  const auto& notes = out.placement.notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.starts_with("the errors of loop closures are 3.") ||
           note.starts_with("the errors of loop closures are 2.");
  }));
}

}  // namespace
}  // namespace radioslam
