// Planted faults of a sound mission: every one is named, with the robot or file at fault, and the sound one
// has none.
#include "radioslam/doctor/check_mission.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>

#include "doctor/sound_mission.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

std::string all_of(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings)
    text += finding.kind + " " + finding.robot + ": " + text_of(finding) + "\n";
  return text;
}

/// Matches of robots a and b every eight seconds, as `written`.
void add_matches(Mission& mission, const std::function<SE3(const SE3&)>& written) {
  for (double t_s = 8; t_s < SoundMission::kDuration_s - 20; t_s += 8) {
    PoseMatch match;
    match.robot_i = RobotIndex(0);
    match.robot_j = RobotIndex(1);
    match.stamp_i = Stamp::from_seconds(t_s);
    match.stamp_j = Stamp::from_seconds(t_s + 7);
    match.T_i_j = written(lift(true_pose(0, t_s)).inverse() * lift(true_pose(1, t_s + 7)));
    match.covariance = isotropic_covariance(0.1, 0.02);
    mission.matches.push_back(match);
  }
}

TEST(CheckMission, HasNothingToSayOfSoundMissions) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto findings = check_mission(SoundMission::make(seed));
    EXPECT_TRUE(findings.empty()) << all_of(findings);
  }
}

TEST(CheckMission, HasNothingToSayOfSoundMatches) {
  Mission mission = SoundMission::make();
  add_matches(mission, [](const SE3& T_i_j) { return T_i_j; });
  EXPECT_TRUE(check_mission(mission).empty()) << all_of(check_mission(mission));
}

TEST(CheckMission, HasNothingToSayOfAnEmptyMission) { EXPECT_TRUE(check_mission(Mission{}).empty()); }

TEST(CheckMission, IsTheSameForAnyNumberOfThreads) {
  Mission mission = SoundMission::make();
  for (RangeMeasurement& range : mission.ranges) range.range_m *= 1000;
  set_thread_count(1);
  const std::string one = all_of(check_mission(mission));
  set_thread_count(4);
  EXPECT_EQ(all_of(check_mission(mission)), one);
  set_thread_count(0);
}

bool has_error(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const auto& f) { return f.severity == Severity::kError; });
}

/// Odometry of one robot for the first minute only, radio for all four.
TEST(CheckMission, RadioMayLastLongerThanTheOdometry) {
  Mission mission = SoundMission::make();
  std::vector<StampedPose<SE3>> poses;
  for (const auto& pose : mission.robots[1].odometry)
    if (pose.stamp.seconds() < 60) poses.push_back(pose);
  mission.robots[1].odometry = Trajectory<SE3>(std::move(poses));
  const auto findings = check_mission(mission);
  EXPECT_FALSE(has_error(findings)) << all_of(findings);
}

TEST(CheckMission, ARobotMayStandStill) {
  Mission mission = SoundMission::make();
  Robot& parked = mission.robots[2];
  std::vector<StampedPose<SE3>> poses;
  for (const auto& pose : parked.odometry) poses.push_back({pose.stamp, SE3()});
  parked.odometry = Trajectory<SE3>(std::move(poses));
  parked.inertial.clear();
  parked.wifi.clear();
  for (RangeMeasurement& range : mission.ranges) {
    const std::size_t other = range.i.robot.index();
    if (range.j.robot == RobotIndex(2))
      range.range_m = distance_to(true_place(2, 0), other, range.stamp.seconds());
  }
  std::erase_if(mission.aoa_measurements, [](const auto& angle) {
    return angle.receiver == RobotIndex(2) || angle.transmitter.robot == RobotIndex(2);
  });
  const auto findings = check_mission(mission);
  EXPECT_TRUE(findings.empty()) << all_of(findings);
}

/// Half a kilometre along x, three per cent uphill.
TEST(CheckMission, AStraightRoadMayRise) {
  Mission mission;
  mission.robots.resize(1);
  mission.robots[0].id = "a";
  std::vector<StampedPose<SE3>> poses;
  for (int k = 0; k <= 500; ++k)
    poses.push_back(
        {Stamp::from_seconds(0.5 * k), SE3({1.0 * k, 0, 0.03 * k}, Eigen::Quaterniond::Identity())});
  mission.robots[0].odometry = Trajectory<SE3>(std::move(poses));
  EXPECT_TRUE(check_mission(mission).empty()) << all_of(check_mission(mission));
}

/// Anchors in the coordinates of a map.
TEST(CheckMission, AnchorsMayBeFarFromTheOrigin) {
  Mission mission = SoundMission::make();
  const Eigen::Vector3d origin(5e5, 5.4e6, 0);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d place(20.0 * (k % 2), 15.0 * k);
    mission.anchors.push_back(
        {std::string(1, static_cast<char>('p' + k)), origin + Eigen::Vector3d(place.x(), place.y(), 0), 0.1});
    for (double t_s = 2; t_s < SoundMission::kDuration_s; t_s += 4) {
      RangeMeasurement range{Stamp::from_seconds(t_s), {}, {}, distance_to(place, 0, t_s), 0.2};
      range.i.robot = RobotIndex(0);
      range.j.anchor = AnchorIndex(static_cast<std::size_t>(k));
      mission.ranges.push_back(range);
    }
  }
  EXPECT_TRUE(check_mission(mission).empty()) << all_of(check_mission(mission));
}

void change_odometry(Robot& robot, const std::function<StampedPose<SE3>(const StampedPose<SE3>&)>& change) {
  std::vector<StampedPose<SE3>> poses;
  for (const auto& pose : robot.odometry) poses.push_back(change(pose));
  robot.odometry = Trajectory<SE3>(std::move(poses));
}

void shift(Stamp& stamp, double seconds) { stamp.ns += Stamp::from_seconds(seconds).ns; }

void shift_robot(Robot& robot, double seconds) {
  change_odometry(robot, [&](auto pose) {
    shift(pose.stamp, seconds);
    return pose;
  });
  for (WifiScan& scan : robot.wifi) shift(scan.stamp, seconds);
  for (ImuSample& sample : robot.inertial) shift(sample.stamp, seconds);
}

void state_starts(Mission& mission) {
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    mission.robots[r].initial_pose = lift(true_pose(r, 0));
}

void keep_fingerprints_alone(Mission& mission) {
  mission.ranges.clear();
  mission.aoa_measurements.clear();
}

TEST(CheckMission, HasNothingToSayOfTrueStarts) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Mission mission = SoundMission::make(seed);
    state_starts(mission);
    EXPECT_TRUE(check_mission(mission).empty()) << all_of(check_mission(mission));
    keep_fingerprints_alone(mission);
    EXPECT_TRUE(check_mission(mission).empty()) << all_of(check_mission(mission));
  }
}

Truth truth_of(const Mission& mission, const std::function<SE3(const SE3&)>& change) {
  Truth truth;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    std::vector<StampedPose<SE3>> poses;
    for (double t_s = 0; t_s < SoundMission::kDuration_s; t_s += 1)
      poses.push_back({Stamp::from_seconds(t_s), change(lift(true_pose(r, t_s)))});
    truth.robots.push_back({mission.robots[r].id, Trajectory<SE3>(std::move(poses))});
  }
  return truth;
}

TEST(CheckTruth, AMirroredTruthIsNamed) {
  const Mission mission = SoundMission::make();
  EXPECT_TRUE(check_truth(mission, truth_of(mission, [](const SE3& pose) { return pose; })).empty());
  const auto findings = check_truth(mission, truth_of(mission, [](const SE3& pose) {
                                      const Eigen::Vector3d& t = pose.translation();
                                      return SE3({t.x(), -t.y(), t.z()}, pose.rotation().inverse());
                                    }));
  ASSERT_EQ(findings.size(), 3U) << all_of(findings);
  EXPECT_EQ(findings[1].kind, "handedness");
  EXPECT_EQ(findings[1].file, "robots/b/groundtruth.tum");
}

/// As where z points down in one of the two.
TEST(CheckTruth, InSpaceAFrameThatIsTurnedOverIsNoMirrorImage) {
  Mission mission = SoundMission::make();
  const SE3 over({0, 0, 0}, Eigen::Quaterniond(0, 1, 0, 0));
  const Truth truth = truth_of(mission, [&](const SE3& pose) { return over * pose; });
  EXPECT_EQ(check_truth(mission, truth).size(), 3U);
  mission.dimension = 3;
  EXPECT_TRUE(check_truth(mission, truth).empty()) << all_of(check_truth(mission, truth));
}

TEST(CheckTruth, ATruthOnAnotherClockIsNamed) {
  Mission mission = SoundMission::make();
  const Truth truth = truth_of(mission, [](const SE3& pose) { return pose; });
  shift_robot(mission.robots[2], 1.7e9);
  const auto findings = check_truth(mission, truth);
  ASSERT_EQ(findings.size(), 1U) << all_of(findings);
  EXPECT_EQ(findings[0].kind, "clock");
  EXPECT_EQ(findings[0].robot, "c");
}

TEST(CheckTruth, FaultsOfOneFileAreNamed) {
  const Mission mission = SoundMission::make();
  const Truth sound = truth_of(mission, [](const SE3& pose) { return pose; });
  const auto kind_of = [&](const auto& fault) {
    Truth truth = sound;
    fault(truth.robots);
    const auto findings = check_truth(mission, truth);
    return findings.size() == 1 && findings[0].robot == "b" ? findings[0].kind : all_of(findings);
  };
  const auto changed = [](RobotTruth& robot, const auto& change) {
    std::vector<StampedPose<SE3>> poses(robot.poses.begin(), robot.poses.end());
    for (auto& row : poses) change(row);
    robot.poses = Trajectory<SE3>(std::move(poses));
  };
  using Row = StampedPose<SE3>;
  EXPECT_EQ(kind_of([&](auto& robots) {
              changed(robots[1],
                      [](Row& row) { row.pose = SE3(1000 * row.pose.translation(), row.pose.rotation()); });
            }),
            "unit");
  EXPECT_EQ(kind_of([&](auto& robots) {
              changed(robots[1], [](Row& row) { row.stamp = Stamp::from_seconds(row.stamp.seconds() + 5); });
            }),
            "clock");
  EXPECT_EQ(kind_of([&](auto& robots) {
              changed(robots[1],
                      [](Row& row) { row.stamp = Stamp::from_seconds(row.stamp.seconds() * 1000); });
            }),
            "unit");
  EXPECT_EQ(kind_of([](auto& robots) { robots[1].poses = robots[0].poses; }), "robot");
}

TEST(CheckTruth, AStartOrARangeThatContradictsItIsNamed) {
  Mission mission = SoundMission::make();
  const Truth truth = truth_of(mission, [](const SE3& pose) { return pose; });
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    mission.robots[r].initial_pose = lift(true_pose(r, 0));
  EXPECT_TRUE(check_truth(mission, truth).empty()) << all_of(check_truth(mission, truth));
  Mission moved = mission;
  moved.robots[1].initial_pose =
      SE3({8, 0, 0}, Eigen::Quaterniond::Identity()) * *moved.robots[1].initial_pose;
  auto findings = check_truth(moved, truth);
  ASSERT_EQ(findings.size(), 1U) << all_of(findings);
  EXPECT_EQ(findings[0].kind, "start");
  EXPECT_EQ(findings[0].robot, "b");
  for (RangeMeasurement& range : mission.ranges)
    if (range.i.robot != RobotIndex(2) && range.j.robot != RobotIndex(2)) range.range_m += 1;
  findings = check_truth(mission, truth);
  ASSERT_EQ(findings.size(), 1U) << all_of(findings);
  EXPECT_EQ(findings[0].kind, "bias");
  EXPECT_NE(findings[0].found.find("between a and b are about 1"), std::string::npos) << findings[0].found;
}

/// Along x, with a little noise to both sides.
TEST(CheckTruth, AStraightPathIsItsOwnMirrorImage) {
  Mission mission;
  mission.robots.resize(1);
  Truth truth;
  std::vector<StampedPose<SE3>> odometry, poses;
  for (int k = 0; k < 200; ++k) {
    const double side_m = 0.2 * std::sin(0.3 * k);
    odometry.push_back({Stamp::from_seconds(k), SE3({1.0 * k, side_m, 0}, Eigen::Quaterniond::Identity())});
    poses.push_back({Stamp::from_seconds(k), SE3({1.0 * k, -side_m, 0}, Eigen::Quaterniond::Identity())});
  }
  mission.robots[0].odometry = Trajectory<SE3>(std::move(odometry));
  truth.robots.push_back({"a", Trajectory<SE3>(std::move(poses))});
  EXPECT_TRUE(check_truth(mission, truth).empty());
}

struct Fault {
  std::string name, kind, robot, file;
  std::function<void(Mission&)> plant;
  friend std::ostream& operator<<(std::ostream& stream, const Fault& fault) { return stream << fault.name; }
};

void for_azimuths(Mission& mission, const std::function<double(double)>& change) {
  for (AoaMeasurement& angle : mission.aoa_measurements)
    for (AoaPath& path : angle.paths) path.azimuth_rad = wrap_angle(change(path.azimuth_rad));
}

SE3 with_translation(const SE3& pose, const Eigen::Vector3d& translation) {
  return {translation, pose.rotation()};
}

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all{
      {"WifiOnTheUnixClock", "clock", "b", "robots/b/wifi.csv",
       [](Mission& m) {
         for (auto& scan : m.robots[1].wifi) shift(scan.stamp, 1.7e9);
       }},
      {"WifiInMilliseconds", "unit", "b", "robots/b/wifi.csv",
       [](Mission& m) {
         for (auto& scan : m.robots[1].wifi) scan.stamp.ns *= 1000;
       }},
      {"RangesInMilliseconds", "unit", "", "radio/ranges.csv",
       [](Mission& m) {
         for (auto& range : m.ranges) range.stamp.ns *= 1000;
       }},
      {"OdometryThatStops", "frozen", "b", "robots/b/odometry.tum",
       [](Mission& m) {
         std::vector<StampedPose<SE3>> poses(m.robots[1].odometry.begin(), m.robots[1].odometry.end());
         for (std::size_t k = poses.size() / 2; k < poses.size(); ++k) poses[k].pose = poses[k - 1].pose;
         m.robots[1].odometry = Trajectory<SE3>(std::move(poses));
       }},
      {"MatchesInverted", "convention", "", "matches.csv",
       [](Mission& m) { add_matches(m, [](const SE3& T_i_j) { return T_i_j.inverse(); }); }},
      {"MatchesWithWFirst", "column-order", "", "matches.csv",
       [](Mission& m) {
         add_matches(m, [](const SE3& T_i_j) {
           const Eigen::Quaterniond& q = T_i_j.rotation();
           return SE3(T_i_j.translation(), Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()));
         });
       }},
      {"WifiHalfAMinuteLate", "clock", "b", "robots/b/wifi.csv",
       [](Mission& m) {
         for (auto& scan : m.robots[1].wifi) shift(scan.stamp, 30);
       }},
      {"ImuThreeSecondsLate", "clock", "c", "robots/c/imu.csv",
       [](Mission& m) {
         for (auto& sample : m.robots[2].inertial) shift(sample.stamp, 3);
       }},
      {"RobotOnTheUnixClock", "clock", "b", "robots/b/odometry.tum",
       [](Mission& m) { shift_robot(m.robots[1], 1.7e9); }},
      {"RobotFiveSecondsLate", "clock", "b", "robots/b/odometry.tum",
       [](Mission& m) { shift_robot(m.robots[1], 5); }},
      {"RangesHalfAMinuteLate", "clock", "", "radio/ranges.csv",
       [](Mission& m) {
         for (auto& range : m.ranges) shift(range.stamp, 30);
       }},
      {"OdometryInMillimetres", "unit", "a", "robots/a/odometry.tum",
       [](Mission& m) {
         change_odometry(m.robots[0], [](auto p) {
           p.pose = with_translation(p.pose, 1000 * p.pose.translation());
           return p;
         });
       }},
      {"RangesInMillimetres", "unit", "", "radio/ranges.csv",
       [](Mission& m) {
         for (auto& range : m.ranges) range.range_m *= 1000, range.sigma_m *= 1000;
       }},
      {"RangesInFeet", "unit", "", "radio/ranges.csv",
       [](Mission& m) {
         for (auto& range : m.ranges) range.range_m /= 0.3048;
       }},
      {"GyroscopeInDegrees", "unit", "a", "robots/a/imu.csv",
       [](Mission& m) {
         for (auto& sample : m.robots[0].inertial) sample.angular_rate_radps *= 57.3;
       }},
      {"AccelerationInG", "unit", "a", "robots/a/imu.csv",
       [](Mission& m) {
         for (auto& sample : m.robots[0].inertial) sample.specific_force_mps2 /= 9.81;
       }},
      {"FrequencyInGigahertz", "unit", "b", "robots/b/wifi.csv",
       [](Mission& m) {
         for (auto& scan : m.robots[1].wifi)
           for (auto& reading : scan.readings) reading.frequency_mhz = 2.412F;
       }},
      {"YawOfTheOtherSign", "handedness", "b", "robots/b/odometry.tum",
       [](Mission& m) {
         change_odometry(m.robots[1], [](auto p) {
           p.pose = SE3(p.pose.translation(), p.pose.rotation().inverse());
           return p;
         });
       }},
      {"MirroredWithoutImu", "handedness", "b", "robots/b/odometry.tum",
       [](Mission& m) {
         m.robots[1].inertial.clear();
         change_odometry(m.robots[1], [](auto p) {
           const auto& t = p.pose.translation();
           p.pose = SE3({t.x(), -t.y(), t.z()}, p.pose.rotation().inverse());
           return p;
         });
       }},
      {"AnglesClockwise", "handedness", "", "radio/aoa.csv",
       [](Mission& m) { for_azimuths(m, [](double a) { return -a; }); }},
      {"ArrayTurned", "bias", "c", "radio/aoa.csv",
       [](Mission& m) {
         for (auto& angle : m.aoa_measurements)
           if (angle.receiver == RobotIndex(2))
             for (auto& path : angle.paths) path.azimuth_rad = wrap_angle(path.azimuth_rad + 0.9);
       }},
      {"EndsExchanged", "column-order", "", "radio/aoa.csv",
       [](Mission& m) {
         for (auto& angle : m.aoa_measurements) std::swap(angle.receiver, angle.transmitter.robot);
       }},
      {"QuaternionWFirst", "column-order", "c", "robots/c/odometry.tum",
       [](Mission& m) {
         change_odometry(m.robots[2], [](auto p) {
           const auto& q = p.pose.rotation();
           p.pose = SE3(p.pose.translation(), Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()));
           return p;
         });
       }},
      {"HeightInPlaceOfY", "column-order", "c", "robots/c/odometry.tum",
       [](Mission& m) {
         change_odometry(m.robots[2], [](auto p) {
           const auto& t = p.pose.translation();
           p.pose = with_translation(p.pose, {t.x(), t.z(), t.y()});
           return p;
         });
       }},
      {"Jump", "speed", "a", "robots/a/odometry.tum",
       [](Mission& m) {
         change_odometry(m.robots[0], [](auto p) {
           if (p.stamp.seconds() > 120)
             p.pose = with_translation(p.pose, p.pose.translation() + Eigen::Vector3d(30, 0, 0));
           return p;
         });
       }},
      {"Gap", "gap", "a", "robots/a/odometry.tum",
       [](Mission& m) {
         std::vector<StampedPose<SE3>> poses;
         for (const auto& p : m.robots[0].odometry)
           if (p.stamp.seconds() < 100 || p.stamp.seconds() > 130) poses.push_back(p);
         m.robots[0].odometry = Trajectory<SE3>(std::move(poses));
       }},
      {"StartElsewhere", "start", "b", "mission.yaml",
       [](Mission& m) {
         state_starts(m);
         m.robots[1].initial_pose = with_translation(*m.robots[1].initial_pose, {60, 40, 0});
       }},
      {"StartsExchanged", "start", "", "mission.yaml",
       [](Mission& m) {
         state_starts(m);
         std::swap(m.robots[0].initial_pose, m.robots[2].initial_pose);
       }},
      {"StartElsewhereByFingerprints", "start", "b", "mission.yaml",
       [](Mission& m) {
         keep_fingerprints_alone(m);
         state_starts(m);
         m.robots[1].initial_pose = with_translation(*m.robots[1].initial_pose, {30, 20, 0});
       }},
      {"StartTurnedByFingerprints", "start", "c", "mission.yaml",
       [](Mission& m) {
         keep_fingerprints_alone(m);
         state_starts(m);
         m.robots[2].initial_pose = *m.robots[2].initial_pose * lift(SE2({0, 0}, 1.6));
       }},
      {"StartsExchangedByFingerprints", "start", "", "mission.yaml",
       [](Mission& m) {
         keep_fingerprints_alone(m);
         state_starts(m);
         std::swap(m.robots[0].initial_pose, m.robots[2].initial_pose);
       }},
      {"FourRangesInMillimetres", "unit", "", "radio/ranges.csv",
       [](Mission& m) {
         std::vector<RangeMeasurement> few;
         for (const std::size_t k : {0U, 120U, 240U, 360U}) few.push_back(m.ranges[k]);
         for (auto& range : few) range.range_m *= 1000;
         m.ranges = few;
         m.aoa_measurements.clear();
       }},
      {"NotConnected", "not-connected", "c", "",
       [](Mission& m) {
         m.robots[2].wifi.clear();
         std::erase_if(m.ranges, [](const auto& range) { return range.j.robot == RobotIndex(2); });
         std::erase_if(m.aoa_measurements, [](const auto& angle) {
           return angle.receiver == RobotIndex(2) || angle.transmitter.robot == RobotIndex(2);
         });
       }},
      {"CarriedAccessPoint", "moving-access-point", "a", "robots/a/wifi.csv",
       [](Mission& m) {
         m.access_points.push_back("ff:00:00:00:00:01");
         for (auto& scan : m.robots[0].wifi)
           scan.readings.push_back({AccessPointIndex(m.access_points.size() - 1), 2412, -40});
       }},
      {"OneRecordingTwice", "duplicate", "c", "robots/c/odometry.tum",
       [](Mission& m) { m.robots[2].odometry = m.robots[0].odometry; }},
      {"ScansRepeated", "stale", "b", "robots/b/wifi.csv",
       [](Mission& m) {
         for (std::size_t k = 1; k < m.robots[1].wifi.size(); k += 2)
           m.robots[1].wifi[k].readings = m.robots[1].wifi[k - 1].readings;
       }},
      {"SigmaTooSmall", "noise", "", "radio/ranges.csv",
       [](Mission& m) {
         for (auto& range : m.ranges) range.sigma_m = 0.01;
       }},
      {"RangesTooLong", "bias", "", "radio/ranges.csv",
       [](Mission& m) {
         for (auto& range : m.ranges) range.range_m += 6;
       }},
      {"OneRobotHigher", "height", "b", "radio/ranges.csv",
       [](Mission& m) {
         for (auto& range : m.ranges)
           if (range.i.robot == RobotIndex(1) || range.j.robot == RobotIndex(1))
             range.range_m = std::hypot(range.range_m, 35);
       }},
      {"GyroscopeBias", "bias", "c", "robots/c/imu.csv",
       [](Mission& m) {
         for (auto& sample : m.robots[2].inertial) sample.angular_rate_radps.z() += 0.2;
       }},
      {"GravityRemoved", "bias", "c", "robots/c/imu.csv",
       [](Mission& m) {
         for (auto& sample : m.robots[2].inertial) sample.specific_force_mps2.z() -= 9.6;
       }},
      {"UtmCoordinates", "frame", "a", "robots/a/odometry.tum",
       [](Mission& m) {
         change_odometry(m.robots[0], [](auto p) {
           p.pose = with_translation(p.pose, p.pose.translation() + Eigen::Vector3d(5e5, 5.4e6, 0));
           return p;
         });
       }},
      {"AlmostNothing", "too-little", "b", "robots/b/odometry.tum",
       [](Mission& m) {
         m.robots[1].odometry = Trajectory<SE3>({m.robots[1].odometry[0], m.robots[1].odometry[5]});
       }},
  };
  return all;
}

class PlantedFault : public testing::TestWithParam<Fault> {};

TEST_P(PlantedFault, IsNamed) {
  const Fault& fault = GetParam();
  Mission mission = SoundMission::make(7);
  fault.plant(mission);
  const auto findings = check_mission(mission);
  bool is_named = false;
  for (const Finding& finding : findings)
    is_named = is_named ||
               (finding.kind == fault.kind && finding.robot == fault.robot && finding.file == fault.file);
  EXPECT_TRUE(is_named) << all_of(findings);
}

INSTANTIATE_TEST_SUITE_P(All, PlantedFault, testing::ValuesIn(faults()),
                         [](const auto& fault) { return fault.param.name; });

TEST(CheckMission, PutsErrorsFirst) {
  Mission mission = SoundMission::make();
  for (RangeMeasurement& range : mission.ranges) range.range_m *= 1000, range.sigma_m *= 1000;
  for (auto& scan : mission.robots[1].wifi)
    for (auto& reading : scan.readings) reading.frequency_mhz = 2.412F;
  const auto findings = check_mission(mission);
  ASSERT_EQ(findings.size(), 2U) << all_of(findings);
  EXPECT_EQ(findings[0].severity, Severity::kError);
  EXPECT_EQ(findings[1].severity, Severity::kWarning);
}

}  // namespace
}  // namespace radioslam
