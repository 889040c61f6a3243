#include "radioslam/joint/closures/closure_admission.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "joint/closures/block_team.hpp"
#include "radioslam/joint/closures/team_loops.hpp"

namespace radioslam {
namespace {

const SE2 kElsewhere({20, -35}, 0.8);

/// `right` true matches of two robots and `wrong` ones that agree with each other.
BlockTeam two_robots(std::size_t right, std::size_t wrong) {
  BlockTeam team(2);
  for (std::size_t k = 0; k < right; ++k) team.see(0, 40 + 15 * k, 1, 15 * k);
  for (std::size_t k = 0; k < wrong; ++k) team.mistake(0, 20 + 7 * k, 1, 90 - k, kElsewhere);
  return team;
}

/// The keyframes of the first `count` closures.
CandidateList candidates_of(const BlockTeam::Outcome& out, std::size_t count) {
  std::vector<std::vector<Stamp>> stamps;
  for (const RobotVariables& robot : out.joint.robots) stamps.push_back(robot.stamps);
  CandidateList list(std::move(stamps));
  for (std::size_t k = 0; k < count; ++k) {
    const Closure& match = out.closures[k];
    list.push_back({match.robot_i, match.stamp_i, match.robot_j, match.stamp_j});
  }
  return list;
}

std::vector<ClosureAdmission> admitted(const BlockTeam::Outcome& out, const CandidateList* candidates) {
  return admit_closures<SE2>(out.joint, out.alignment, out.closures, candidates, {}, nullptr);
}

TEST(AdmitClosures, AsksForCandidatesWhereOtherMeasurementsRelateTheRobots) {
  auto out = two_robots(6, 1).measured();
  const CandidateList three = candidates_of(out, 3);
  for (const ClosureAdmission& of : admitted(out, &three)) EXPECT_EQ(of.admission, Admission::kAdmitted);
  out.alignment.without_matches = {0, 0};
  const auto related = admitted(out, &three);
  for (std::size_t k = 0; k < related.size(); ++k) {
    EXPECT_EQ(related[k].admission, k < 3 ? Admission::kAdmitted : Admission::kSetAside);
    EXPECT_EQ(related[k].reason, k < 3 ? "" : "the views cannot overlap");
  }
  for (const ClosureAdmission& of : admitted(out, nullptr)) EXPECT_EQ(of.admission, Admission::kAdmitted);
}

/// Three that hold vouch for others that the estimate agrees with; two do not.
TEST(CloseByLoops, TestsWhatWasSetAsideWhereThreeOthersHold) {
  for (const std::size_t candidates : {2u, 3u}) {
    auto out = two_robots(6, 1).measured();
    out.alignment.without_matches = {0, 0};
    const CandidateList list = candidates_of(out, candidates);
    close_by_loops(out.joint, out.alignment, out.closures, out.judgements,
                   {.admissions = admitted(out, &list)}, {}, {});
    for (std::size_t k = 0; k < 7; ++k) {
      const bool holds = k < candidates || (candidates == 3 && k < 6);
      EXPECT_EQ(out.judgements[k].reason, holds ? "" : "the views cannot overlap") << candidates << " " << k;
      EXPECT_EQ(out.judgements[k].status, holds ? ClosureStatus::kAccepted : ClosureStatus::kRejected);
    }
  }
}

TEST(CloseByLoops, LeavesOutWhatIsExcluded) {
  auto out = two_robots(6, 0).measured();
  std::vector<ClosureAdmission> admissions(6);
  admissions[4] = {Admission::kExcluded, "the angles of arrival disagree"};
  close_by_loops(out.joint, out.alignment, out.closures, out.judgements, {.admissions = admissions}, {}, {});
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_EQ(out.judgements[k].reason, k == 4 ? "the angles of arrival disagree" : "");
}

TEST(CloseByLoops, WeighsClosuresByTheirScale) {
  auto out = two_robots(4, 0).measured();
  std::vector<ClosureAdmission> admissions(4);
  admissions[0].information_scale = 0.25;
  const auto loops = team_loops(out.joint, out.closures, admissions);
  EXPECT_NEAR(loops[0].covariance(0, 0), 4 * loops[1].covariance(0, 0), 1e-12);
}

/// What is uncertain of the radio's frames stays so where closures join none.
TEST(CloseByLoops, KeepTheWeightOfFramesThatTheyDoNotJoin) {
  auto out = two_robots(6, 0).measured();
  out.alignment.weight = 0.4;
  close_by_loops(out.joint, out.alignment, out.closures, out.judgements, {}, {}, {});
  EXPECT_LE(out.alignment.weight, 0.4);
}

TEST(CloseByAll, KeepsWhatContradicts) {
  auto out = two_robots(4, 2).measured();
  out.closures[1].stamp_j = Stamp{1000 * kNanosecondsPerSecond};
  const std::size_t before = out.joint.team.graph.relative_poses.size();
  close_by_all(out.joint, out.closures, std::vector<ClosureAdmission>(6), out.judgements, {}, {});
  EXPECT_EQ(out.joint.team.graph.relative_poses.size(), before + 5);
  EXPECT_EQ(out.judgements[1].reason, "no odometry at its time");
  for (const std::size_t k : {0u, 4u, 5u}) EXPECT_EQ(out.judgements[k].status, ClosureStatus::kAccepted);
  double sum = 0;
  for (const ClosureJudgement& judgement : out.judgements) sum += judgement.statistic;
  EXPECT_GT(sum, 2 * kPoseChiSquared99<SE2>);
}

/// A component in the common frame stays where it is, whichever end of the loops it has.
TEST(CloseByLoops, MovesNoRobotOutOfTheCommonFrame) {
  for (const std::size_t absolute : {0u, 1u}) {
    auto out = two_robots(6, 0).measured();
    out.alignment.absolute[absolute] = out.alignment.in_common_frame[absolute] = true;
    const SE2 before = out.joint.team.graph.poses[out.joint.team.segments[absolute].first_pose];
    close_by_loops(out.joint, out.alignment, out.closures, out.judgements, {}, {}, {});
    EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 0}));
    const SE2 after = out.joint.team.graph.poses[out.joint.team.segments[absolute].first_pose];
    EXPECT_LT((after.translation() - before.translation()).norm(), 2) << absolute;
  }
}

}  // namespace
}  // namespace radioslam
