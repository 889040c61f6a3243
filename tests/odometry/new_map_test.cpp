// Tracking losses, by scans that match no map for long or are missing: a new map is started, and the error of
// the step onto it agrees with its stated covariance.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <functional>

#include "lidar/scan_drive.hpp"
#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/pipeline/pipeline.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr std::size_t kMaxLostScans = 10;  // of LidarOdometryParams

/// A drive on which a new map is started.
struct BrokenDrive {
  ScanDrive drive;
  std::size_t last = 0, next = 0;  ///< the scans on either side of the step to the new map
};

/// Ten minutes without scans, during which the robot moves elsewhere in the room.
BrokenDrive drive_with_a_gap(std::size_t until) {
  const ScanDrive whole = drive_along(furnished_room(), planar_scanner(), around_furnished_room(40), 1);
  BrokenDrive broken;
  broken.last = 9;
  broken.next = 10;
  for (std::size_t k = 0; k < whole.scans.size(); ++k) {
    if (k > broken.last && k < until) continue;
    const double later_s = k > broken.last ? 600 : 0;
    broken.drive.stamps.push_back(Stamp::from_seconds(whole.stamps[k].seconds() + later_s));
    broken.drive.truth.push_back(whole.truth[k]);
    broken.drive.scans.push_back(whole.scans[k]);
  }
  return broken;
}

/// The surroundings change completely, as when a lift's doors open. The robot moves by `step` per scan until
/// the new map is started, and through the hall from there on.
BrokenDrive drive_by_lift(const SE3& step) {
  constexpr std::size_t kInRoom = 10;
  ScanDrive drive = drive_along(furnished_room(), planar_scanner(), around_furnished_room(40), 10);
  drive.truth.resize(kInRoom);
  drive.scans.resize(kInRoom);
  auto poses = through_furnished_hall(40);
  poses.resize(16);
  std::vector<SE3> arriving{poses.front()};
  for (std::size_t k = 0; k < kMaxLostScans; ++k)
    arriving.insert(arriving.begin(), arriving.front() * step.inverse());
  poses.insert(poses.begin(), arriving.begin(), arriving.end() - 1);
  const ScanDrive hall = drive_along(furnished_hall(), planar_scanner(), poses, 11);
  const SE3 T_room_hall = drive.truth.back() * step * hall.truth.front().inverse();
  for (std::size_t k = 0; k < hall.scans.size(); ++k) {
    drive.truth.push_back(T_room_hall * hall.truth[k]);
    drive.scans.push_back(hall.scans[k]);
  }
  drive.stamps.clear();
  for (std::size_t k = 0; k < drive.scans.size(); ++k)
    drive.stamps.push_back(Stamp::from_seconds(0.1 * static_cast<double>(k)));
  return {drive, kInRoom - 1, kInRoom + kMaxLostScans};
}

Mission mission_of_drive(const ScanDrive& drive) {
  Robot robot;
  robot.id = "a";
  robot.lidar = log_of(drive);
  Mission mission;
  mission.name = "new map";
  mission.dimension = 2;
  mission.robots = {robot};
  return mission;
}

std::size_t scan_number_at(const ScanDrive& drive, Stamp stamp) {
  return static_cast<std::size_t>(std::find(drive.stamps.begin(), drive.stamps.end(), stamp) -
                                  drive.stamps.begin());
}

SE3 true_step(const ScanDrive& drive, Stamp from, Stamp to) {
  return drive.truth[scan_number_at(drive, from)].inverse() * drive.truth[scan_number_at(drive, to)];
}

bool is_noted(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// All steps but the one onto the new map are accurate; the error of that one agrees with its covariance.
void expect_steps(const Trajectory<SE3>& rows, const BrokenDrive& broken,
                  const std::function<SE3::Jacobian(Stamp, Stamp)>& covariance_of) {
  const ScanDrive& drive = broken.drive;
  bool is_there = false;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const Stamp from = rows[k - 1].stamp, to = rows[k].stamp;
    const SE3 step = rows[k - 1].pose.inverse() * rows[k].pose;
    const SE3 error = step.inverse() * true_step(drive, from, to);
    if (from <= drive.stamps[broken.last] && drive.stamps[broken.next] <= to) {
      is_there = true;
      const SE3::Tangent xi = error.log();
      const double nees = xi.dot(covariance_of(from, to).llt().solve(xi));
      EXPECT_LT(nees, chi_squared_quantile(0.99, 6));
    } else {
      EXPECT_LT(error.translation().norm(), 0.06) << k;
      EXPECT_LT(error.log().tail<3>().norm(), kDegree) << k;
    }
  }
  EXPECT_TRUE(is_there);
}

/// Checks both the odometry and the estimate.
void expect_known_unknown(const BrokenDrive& broken, std::size_t lost) {
  const Mission recorded = mission_of_drive(broken.drive);
  const RunResult result = run_pipeline(recorded, {}).result;
  const MeasuredScans measured = measure_scans(recorded, {}, {}, {});
  const Mission mission = with_odometry(recorded, measured, {});
  EXPECT_EQ(measured.lost, lost);
  EXPECT_EQ(measured.registered + lost, broken.drive.scans.size());
  for (const auto& notes : {measured.notes, result.notes}) {
    EXPECT_TRUE(
        is_noted(notes, "robot a: 1 tracking losses (scans missing or not matching for long): a new map"));
    EXPECT_EQ(is_noted(notes, "robot a: " + std::to_string(lost) + " scans did not match"), lost > 0);
  }
  const Robot& robot = mission.robots[0];
  for (const auto& rows : {robot.odometry, result.robots[0].estimate})
    expect_steps(rows, broken, [&](Stamp from, Stamp to) {
      return measured_covariance(robot.odometry_noise.steps, from, to);
    });
}

TEST(NewMap, AfterALongTimeWithoutScans) {
  for (const std::size_t until : {18U, 25U, 30U}) expect_known_unknown(drive_with_a_gap(until), 0);
}

/// The robot keeps its velocity, stops, or rotates on the spot.
TEST(NewMap, AfterScansThatMatchNothingForLong) {
  const SE3 on = SE3::exp(planar_motion(0.35, 0, 0.1)), stop, turns = SE3::exp(planar_motion(0, 0, 0.12));
  for (const SE3& step : {on, stop, turns}) expect_known_unknown(drive_by_lift(step), kMaxLostScans);
}

}  // namespace
}  // namespace radioslam
