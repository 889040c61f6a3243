#include "radioslam/front_end/front_end.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lidar/scan_drive.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/front_end/replay.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/records/logs_of_mission.hpp"
#include "radioslam/records/mission_of_logs.hpp"
#include "radioslam/sim/scenarios/city.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr RobotIndex kSelf{0};

Mission city() {
  CityParams params;
  params.path_length_m = 400;
  params.min_contact_s = 5;
  params.radio.links = 60;
  return simulate_city(params, 3).mission;
}

/// A robot that scans a furnished room; its wheels, if it has any, count in a frame of their own.
Mission scanning_mission(int scans = 60, bool has_wheels = false) {
  std::vector<SE3> poses;
  for (int k = 0; k < scans; ++k) {
    const double angle = 0.04 * k;
    poses.push_back(pose_at(2 * std::cos(angle), 0.9 * std::sin(angle), 1.2,
                            std::atan2(0.9 * std::cos(angle), -2 * std::sin(angle))));
  }
  Mission mission;
  mission.dimension = 2;
  Robot& robot = mission.robots.emplace_back();
  robot.id = "a";
  const ScanDrive drive = drive_along(furnished_room(), planar_scanner(180), poses, 1);
  robot.lidar = log_of(drive);
  if (!has_wheels) return mission;
  const SE3 T_wheels_room = pose_at(7, -5, 0, 2);
  std::vector<StampedPose<SE3>> wheels;
  for (std::size_t k = 0; k < poses.size(); ++k)
    wheels.push_back({drive.stamps[k], T_wheels_room * poses[k]});
  robot.odometry = Trajectory<SE3>(std::move(wheels));
  return mission;
}

std::vector<Sample> samples_of(const Mission& mission) {
  const Robot& robot = mission.robots[0];
  std::vector<Sample> samples(robot.odometry.begin(), robot.odometry.end());
  samples.insert(samples.end(), robot.inertial.begin(), robot.inertial.end());
  for (std::size_t k = 0; k < robot.lidar.size(); ++k)
    samples.push_back(ScanSample{robot.lidar.stamps[k], robot.lidar.read(k)});
  for (const RangeMeasurement& range : mission.ranges)
    if (range.i.robot == kSelf || range.j.robot == kSelf) samples.push_back(range);
  for (const AoaMeasurement& angles : mission.aoa_measurements)
    if (angles.receiver == kSelf) samples.push_back(angles);
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); });
  return samples;
}

struct Said {
  std::vector<std::string> records;
  std::vector<OnlinePose> poses;
  std::vector<FrontEndEvent> events;
  std::size_t left_out = 0;
};

MotionSources sources_of(const Robot& robot) {
  return {!robot.odometry.empty(), !robot.inertial.empty(), !robot.lidar.empty()};
}

Said live_through(const Mission& mission, const std::vector<Sample>& samples, bool to_the_end = true) {
  CloudStore clouds;
  FrontEnd front_end(mission, kSelf, sources_of(mission.robots[0]), {}, {}, clouds);
  for (const Sample& sample : samples) front_end.add(sample);
  if (to_the_end) front_end.finish();
  return {front_end.take_records(), front_end.take_poses(), front_end.events(), front_end.left_out()};
}

/// Every sample up to `late_s` late, in the order in which they then come.
std::vector<Sample> delayed(std::vector<Sample> samples, double late_s, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<std::pair<double, Sample>> arrivals;
  for (Sample& sample : samples)
    arrivals.emplace_back(stamp_of(sample).seconds() + late_s * rng.uniform(0, 1), std::move(sample));
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Sample> late;
  for (auto& [at, sample] : arrivals) late.push_back(std::move(sample));
  return late;
}

void expect_same(const Said& a, const Said& b) {
  EXPECT_EQ(a.records, b.records);
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t k = 0; k < a.poses.size(); ++k) {
    EXPECT_EQ(a.poses[k].stamp, b.poses[k].stamp);
    EXPECT_EQ(a.poses[k].T_start_body.translation(), b.poses[k].T_start_body.translation());
  }
}

TEST(FrontEnd, SaysTheLogOfTheRecordedMission) {
  Mission mission = city();
  mission.matches.clear();  // of which the later end decides on keyframes when the earlier one is past
  const MissionLogs logs = logs_of(mission, {});
  const auto replayed = replay(mission, {}, {});
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    EXPECT_EQ(replayed[r].log.records, logs.robots[r].records);
    EXPECT_EQ(replayed[r].left_out, 0u);
    EXPECT_TRUE(replayed[r].events.empty());
  }
}

TEST(FrontEnd, SamplesThatAreALittleLateChangeNothing) {
  for (const Mission& mission : {city(), scanning_mission()}) {
    const auto samples = samples_of(mission);
    const Said in_order = live_through(mission, samples);
    EXPECT_GT(in_order.records.size(), 3u);
    for (const std::uint64_t seed : {1u, 2u, 3u})
      expect_same(in_order, live_through(mission, delayed(samples, FrontEnd::kLate_s - 1e-6, seed)));
  }
}

TEST(FrontEnd, LaterSamplesAreCountedAndNamedOnce) {
  const Mission mission = city();
  auto samples = samples_of(mission);
  const auto is_range = [](const Sample& sample) { return std::holds_alternative<RangeMeasurement>(sample); };
  const auto first = std::find_if(samples.begin(), samples.end(), is_range);
  const auto second = std::find_if(first + 1, samples.end(), is_range);
  ASSERT_NE(second, samples.end());
  std::vector<Sample> late{*first, *second};
  samples.erase(second);
  samples.erase(first);
  samples.insert(samples.end(), late.begin(), late.end());
  const Said said = live_through(mission, samples);
  EXPECT_EQ(said.left_out, 2u);
  ASSERT_EQ(said.events.size(), 1u);
  EXPECT_EQ(said.events[0].what, "ranges come more than 0.3 s after later samples and are left out");
}

/// What is known at a time does not depend on what comes later.
TEST(FrontEnd, IsCausal) {
  for (const Mission& mission : {city(), scanning_mission()}) {
    const auto samples = samples_of(mission);
    const Said whole = live_through(mission, samples);
    for (const double share : {0.3, 0.7}) {
      const auto count = static_cast<std::ptrdiff_t>(share * static_cast<double>(samples.size()));
      const Said begun = live_through(mission, {samples.begin(), samples.begin() + count}, false);
      ASSERT_LT(begun.records.size(), whole.records.size());
      EXPECT_GT(begun.records.size(), 2u);
      EXPECT_TRUE(std::equal(begun.records.begin(), begun.records.end(), whole.records.begin()));
      for (std::size_t k = 0; k < begun.poses.size(); ++k)
        EXPECT_EQ(begun.poses[k].T_start_body.translation(), whole.poses[k].T_start_body.translation());
    }
  }
}

TEST(FrontEnd, NotesTheWheelsAtKeyframesOfScans) {
  const Mission mission = scanning_mission(60, true);
  CloudStore clouds;
  FrontEnd front_end(mission, kSelf, sources_of(mission.robots[0]), {}, {}, clouds);
  for (const Sample& sample : samples_of(mission)) front_end.add(sample);
  front_end.finish();
  ASSERT_GT(front_end.keyframes().size(), 2U);
  for (const StampedPose<SE3>& keyframe : front_end.keyframes()) {
    const auto noted = front_end.recorded_at_keyframes().find(keyframe.stamp);
    ASSERT_NE(noted, front_end.recorded_at_keyframes().end());
    const SE3 wheels = *mission.robots[0].odometry.at(keyframe.stamp);
    EXPECT_LT((noted->second.inverse() * wheels).log().norm(), 1e-9);
  }
}

TEST(FrontEnd, ReplaysAsTheBatchTracks) {
  const Mission mission = scanning_mission();
  const auto replayed = replay(mission, {}, {});
  ASSERT_TRUE(replayed[0].tracked);
  const MeasuredScans batch = measure_scans(mission, {}, {}, {});
  const auto& poses = replayed[0].tracked->track.poses;
  ASSERT_EQ(poses.size(), batch.robots[0]->odometry->samples.size());
  for (std::size_t k = 0; k < poses.size(); ++k)
    EXPECT_LT((poses[k].T_start_body.translation() - batch.robots[0]->odometry->samples[k].pose.translation())
                  .norm(),
              1e-12);
}

TEST(FrontEnd, ItsLogAloneLeadsToTheEstimateOfTheMission) {
  const Mission mission = scanning_mission(120);
  TeamLog team;
  team.add(replay(mission, {}, {})[0].log);
  const RunResult by_log = run_pipeline(mission_of(team), {}).result,
                  batch = run_pipeline(mission, {}).result;
  ASSERT_EQ(by_log.robots.size(), 1u);
  const auto &a = by_log.robots[0].estimate, &b = batch.robots[0].estimate;
  const SE3 end_a = a.front().pose.inverse() * a.back().pose,
            end_b = b.front().pose.inverse() * b.back().pose;
  EXPECT_LT((end_a.translation() - end_b.translation()).norm(), 0.02);
}

}  // namespace
}  // namespace radioslam
