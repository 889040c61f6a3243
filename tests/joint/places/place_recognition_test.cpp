#include "radioslam/joint/places/place_recognition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "lidar/scanned_room.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kSpacing_m = 0.2;

/// A hall with different things along its walls.
ScannedRoom furnished_hall() {
  ScannedRoom hall;
  hall.boxes = {{{-10, -6, 0}, {10, 6, 3}},    {{-9, -6, 0}, {-7, -5, 2}},  {{-3, -6, 0}, {-2.2, -4.6, 3}},
                {{2, -6, 0}, {5, -5.4, 1.5}},  {{8, -3, 0}, {10, -1, 2.5}}, {{6, 4, 0}, {7, 6, 3}},
                {{-1, 4.8, 0}, {2.5, 6, 1.2}}, {{-6, 4, 0}, {-5, 6, 2}},    {{-10, 1, 0}, {-9, 3, 2.8}}};
  hall.pillars = {{{-4, 0.5}, 0.3}, {{3.5, 1.5}, 0.4}};
  return hall;
}

/// Poses a metre apart along y = `y_m`, towards +x or -x.
std::vector<SE3> along_the_hall(double y_m, bool forward) {
  std::vector<SE3> poses;
  for (int k = 0; k <= 14; ++k)
    poses.push_back(forward ? pose_at(-7.0 + k, y_m, 1, 0) : pose_at(7.0 - k, y_m, 1, std::numbers::pi));
  return poses;
}

ScanOdometry scans_along(const ScannedRoom& room, const std::vector<SE3>& truth, ScannerKind kind,
                         std::uint64_t seed) {
  Rng rng(seed);
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
  if (kind == ScannerKind::kSpatial) scanner.azimuths = 180;
  ScanOdometry scans;
  scans.keyframes.kind = kind;
  scans.keyframes.spacing_m = kSpacing_m;
  scans.keyframes.nominal_inlier_ratio = 0.85;
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const Stamp stamp = Stamp::from_seconds(static_cast<double>(k));
    const SE3 pose = truth.front().inverse() * truth[k];
    scans.keyframes.poses.push_back(pose);
    scans.keyframes.clouds.push_back(
        CloudStore().add(pyramid_of(sweep(room, scanner, truth[k], rng), kSpacing_m, kind)));
    scans.keyframe_stamps.push_back(stamp);
    rows.push_back({stamp, pose});
    if (k > 0) scans.keyframes.step_covariances.push_back(SE3::Jacobian::Identity() * 1e-6);
  }
  scans.odometry.emplace();
  scans.odometry->samples = Trajectory<SE3>(std::move(rows));
  return scans;
}

/// Two robots that pass through the hall in opposite directions.
template <class Pose>
struct HallOf {
  std::vector<std::vector<SE3>> truth{along_the_hall(-1, true), along_the_hall(-2, false)};
  MeasuredScans scans;
  Mission mission;
  TeamEstimate<Pose> team;
  std::vector<CandidateList::Group> allowed;

  /// Robot b's body stands this much higher than a's.
  explicit HallOf(ScannerKind kind_a = ScannerKind::kSpatial, ScannerKind kind_b = ScannerKind::kSpatial,
                  double higher_m = 0) {
    for (SE3& pose : truth[1]) pose = pose_at(0, 0, higher_m, 0) * pose;
    const ScannedRoom room = furnished_hall();
    scans.robots = {scans_along(room, truth[0], kind_a, 1), scans_along(room, truth[1], kind_b, 2)};
    mission.dimension = Pose::kDim;
    mission.robots.resize(2);
    mission.robots[0].id = "a";
    mission.robots[1].id = "b";
    mission = with_odometry(std::move(mission), scans, {.distance_m = 0.9});
    team.joint = build_joint_graph<Pose>(mission, {.distance_m = 0.9}, {});
    team.alignment.component = team.alignment.without_matches = {0, 1};
    team.alignment.in_common_frame = {false, false};
  }

  /// Puts robot b where it is, but for an error, and allows these pairs of keyframes.
  void align(double error_m, const std::function<bool(std::uint32_t, std::uint32_t)>& is_allowed) {
    team.alignment.component = team.alignment.without_matches = {0, 0};
    const SE3 T = truth[0].front().inverse() * pose_at(error_m, 0, 0, 0) * truth[1].front();
    for (const PoseId id : team.joint.robots[1].poses)
      team.joint.team.graph.poses[id.index()] = pose_as<Pose>(T) * team.joint.team.graph.poses[id.index()];
    RelativePoseFactor<Pose> known;
    known.i = team.joint.robots[0].poses.front();
    known.j = team.joint.robots[1].poses.front();
    known.T_i_j = pose_as<Pose>(T);
    known.information = information_as<Pose>(isotropic(1, 100));
    add_factor(team.joint, known, {FactorSource::kLoop, 0, RobotIndex(0), RobotIndex(1), {}, {}});
    CandidateList::Group group{RobotIndex(0), RobotIndex(1), {}};
    for (std::uint32_t i = 0; i < truth[0].size(); ++i)
      for (std::uint32_t j = 0; j < truth[1].size(); ++j)
        if (is_allowed(i, j)) group.rows.push_back({i, j, 0, 0});
    allowed = {group};
  }

  TeamDescriptors described() const { return describe_places(scans, {}, ScanLoopParams().submap_m); }
  RecognisedPlaces recognise(bool pruned, std::vector<PlaceAttempt> tried = {}) const {
    const TeamDescriptors descriptors = described();
    return recognise_places<Pose>(
        {team, mission, scans, descriptors, pruned ? &allowed : nullptr, std::move(tried)}, {}, {}, {}, {});
  }
  PlaceProposals propose(bool pruned, std::optional<VerificationBudget> budget = {},
                         std::vector<PlaceAttempt> tried = {}) const {
    const TeamDescriptors descriptors = described();
    PlaceProposals proposed = propose_places<Pose>(
        {team, mission, scans, descriptors, pruned ? &allowed : nullptr, std::move(tried), {}, budget}, {},
        {}, {});
    for (ScannedRobot& robot : proposed.robots) robot.contexts = nullptr;  // they end here
    return proposed;
  }
  double error_m(const Closure& closure) const {
    const auto k = [](Stamp stamp) { return static_cast<std::size_t>(std::lround(stamp.seconds())); };
    return distance_between(closure.T_i_j,
                            truth[0][k(closure.stamp_i)].inverse() * truth[1][k(closure.stamp_j)]);
  }
};

using Hall = HallOf<SE3>;

template <class Pose>
void expect_right(const HallOf<Pose>& hall, const RecognisedPlaces& found, std::size_t at_least) {
  EXPECT_GE(found.counts.verified, at_least);
  for (const auto& [closure, judgement] : found.closures)
    if (judgement.status == ClosureStatus::kAccepted) {
      EXPECT_LT(hall.error_m(closure), 0.1);
    }
}

TEST(RecognisePlaces, OfRobotsThatNothingAligns) {
  const Hall hall;
  const RecognisedPlaces found = hall.recognise(true);
  expect_right(hall, found, 3);
  EXPECT_EQ(found.counts.compared, found.counts.pairs) << "all descriptors are compared";
  EXPECT_EQ(found.counts.registrations, found.closures.size());
}

TEST(RecognisePlaces, OfPlanarScanners) {
  const Hall hall(ScannerKind::kPlanar, ScannerKind::kPlanar);
  expect_right(hall, hall.recognise(true), 3);
}

TEST(RecognisePlaces, AmongAllowedPairsOnly) {
  Hall hall;
  const auto near = [](std::uint32_t i, std::uint32_t j) { return std::abs(14.0 - i - j) < 4; };
  hall.align(0.5, near);
  const RecognisedPlaces found = hall.recognise(true);
  expect_right(hall, found, 3);
  for (const PlaceAttempt& attempt : found.attempts)
    EXPECT_TRUE(near(static_cast<std::uint32_t>(attempt.i), static_cast<std::uint32_t>(attempt.j)));
  EXPECT_LT(found.counts.allowed, found.counts.pairs);
  EXPECT_LE(found.counts.compared, found.counts.allowed) << "only where descriptors can decide";
  const RecognisedPlaces all = hall.recognise(false);
  EXPECT_LE(2 * found.counts.compared, all.counts.compared);
  EXPECT_LE(found.counts.registrations, all.counts.registrations);
}

TEST(RecognisePlaces, InAPlaneBodiesMayStandAtDifferentHeights) {
  HallOf<SE2> hall(ScannerKind::kSpatial, ScannerKind::kSpatial, 0.5);
  hall.align(0.5, [](std::uint32_t, std::uint32_t) { return true; });
  expect_right(hall, hall.recognise(true), 3);
}

TEST(RecognisePlaces, OfARobotWithoutPointsThereAreNone) {
  Hall hall;
  for (StoredCloud& cloud : hall.scans.robots[1]->keyframes.clouds) cloud = {};
  EXPECT_TRUE(hall.recognise(true).closures.empty());
}

TEST(RecognisePlaces, NotWhereNoPairIsAllowed) {
  Hall hall;
  hall.align(0.5, [](std::uint32_t, std::uint32_t) { return false; });
  EXPECT_TRUE(hall.recognise(true).closures.empty());
}

TEST(RecognisePlaces, AreNotTriedAgain) {
  Hall hall;
  hall.align(0.5, [](std::uint32_t, std::uint32_t) { return true; });
  RecognisedPlaces found = hall.recognise(true);
  const RecognisedPlaces again = hall.recognise(true, found.attempts);
  EXPECT_EQ(again.counts.registrations, 0U);
  const std::size_t registrations = found.counts.registrations;
  found.append(again);
  EXPECT_EQ(found.counts.registrations, registrations);
}

std::vector<std::array<std::size_t, 2>> keyframes_of(const PlaceProposals& proposed) {
  std::vector<std::array<std::size_t, 2>> pairs;
  for (const Proposal& pair : proposed.pairs) pairs.push_back({pair.i, pair.j});
  return pairs;
}

TEST(ProposePlaces, WithinABudgetTheBestOfThoseProposed) {
  Hall hall;
  hall.align(0.5, [](std::uint32_t, std::uint32_t) { return true; });
  const auto all = keyframes_of(hall.propose(true));
  for (const auto order : {VerificationBudget::Order::kWorth, VerificationBudget::Order::kSimilarity,
                           VerificationBudget::Order::kRandom}) {
    const PlaceProposals some = hall.propose(true, VerificationBudget{3, order});
    EXPECT_EQ(some.counts.proposed, all.size());
    EXPECT_EQ(some.pairs.size(), 3U);
    for (const auto& pair : keyframes_of(some)) EXPECT_NE(std::find(all.begin(), all.end(), pair), all.end());
  }
  EXPECT_EQ(keyframes_of(hall.propose(true, VerificationBudget{1000})), all);
  EXPECT_TRUE(hall.propose(true, VerificationBudget{0}).pairs.empty());
}

TEST(ProposePlaces, WhatABudgetLeavesOutIsProposedAgain) {
  for (const bool aligned : {true, false}) {
    Hall hall;
    if (aligned) hall.align(0.5, [](std::uint32_t, std::uint32_t) { return true; });
    auto all = keyframes_of(hall.propose(true));
    const PlaceProposals some = hall.propose(true, VerificationBudget{2});
    std::vector<PlaceAttempt> tried;
    for (const Proposal& pair : some.pairs)
      tried.push_back({RobotIndex(pair.a), RobotIndex(pair.b), pair.i, pair.j, horizontal_sigma(pair.T_i_j)});
    auto found = keyframes_of(hall.propose(true, VerificationBudget{1000}, tried));
    for (const auto& pair : keyframes_of(some)) found.push_back(pair);
    std::sort(found.begin(), found.end());
    std::sort(all.begin(), all.end());
    EXPECT_EQ(found, all) << "each once";
  }
}

TEST(ProposePlaces, SendDescriptorsOfKeyframesWithAnAllowedPartner) {
  Hall hall;
  hall.align(0.5, [](std::uint32_t, std::uint32_t j) { return j < 3; });
  const PlaceProposals pruned = hall.propose(true), unpruned = hall.propose(false);
  const std::size_t all = pruned.counts.bytes_all.descriptors;
  EXPECT_GT(pruned.exchange.sent().descriptors, 0U);
  EXPECT_LT(2 * pruned.exchange.sent().descriptors, all);
  EXPECT_EQ(unpruned.exchange.sent().descriptors, all);
}

/// Twice as many as can be registered; what a later round asks for comes on top, each once.
TEST(ProposePlaces, AskForTheDescriptorsThatMayDecide) {
  Hall hall;
  hall.align(0.5, [](std::uint32_t, std::uint32_t) { return true; });
  const auto bytes = [&](std::size_t registrations, const PlaceExchange& before) {
    const TeamDescriptors descriptors = hall.described();
    return propose_places<SE3>({hall.team,
                                hall.mission,
                                hall.scans,
                                descriptors,
                                &hall.allowed,
                                {},
                                before,
                                VerificationBudget{registrations}},
                               {}, {}, {})
        .exchange;
  };
  const std::size_t one = bytes(1, {}).sent().descriptors / 2;
  const PlaceExchange two = bytes(1, {});
  EXPECT_EQ(bytes(2, {}).sent().descriptors, 4 * one);
  EXPECT_EQ(bytes(1, two).sent().descriptors, 4 * one);
  EXPECT_EQ(bytes(1000, two).sent().descriptors, hall.propose(true).counts.bytes_all.descriptors);
}

TEST(RecognisePlaces, SendTheScansThatAreRegistered) {
  Hall hall;
  hall.align(0.5, [](std::uint32_t i, std::uint32_t j) { return i == 14 && j == 0; });
  const PlaceCounts one = hall.recognise(true).counts, all = hall.recognise(false).counts;
  EXPECT_EQ(one.registrations, 1U);
  EXPECT_GT(one.bytes.scans, 0U);
  EXPECT_LT(10 * one.bytes.scans, one.bytes_all.scans);
  EXPECT_GT(all.bytes.scans, one.bytes.scans);
  EXPECT_LE(all.bytes.scans, all.bytes_all.scans);
}

TEST(RecognisePlaces, OfDifferentScannersAreNotCompared) {
  const Hall hall(ScannerKind::kSpatial, ScannerKind::kPlanar);
  EXPECT_FALSE(has_comparable_scans(hall.scans));
  EXPECT_TRUE(hall.recognise(true).closures.empty());
}

TEST(RecognisePlaces, AreTheSameForAnyNumberOfThreads) {
  const Hall hall;
  set_thread_count(1);
  const RecognisedPlaces alone = hall.recognise(true);
  set_thread_count(4);
  const RecognisedPlaces together = hall.recognise(true);
  set_thread_count(0);
  ASSERT_EQ(alone.closures.size(), together.closures.size());
  for (std::size_t k = 0; k < alone.closures.size(); ++k)
    EXPECT_EQ(alone.closures[k].closure.T_i_j.translation(),
              together.closures[k].closure.T_i_j.translation());
}

}  // namespace
}  // namespace radioslam
