#include "radioslam/doctor/frame_checks.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr double kPlanarTilt_rad = 0.5;

class FrameCheck {
 public:
  FrameCheck(const Mission& mission, const Robot& robot, std::vector<Finding>& findings)
      : robot_(robot), is_planar_(mission.dimension == 2), findings_(findings) {}

  void run() {
    if (check_quaternions()) return;
    check_axes();
    check_heading();
    check_start();
  }

 private:
  void add(std::string kind, Severity severity, std::string found, std::string expected, std::string advice) {
    findings_.push_back({std::move(kind), severity, robot_.id, odometry_file(robot_.id), std::move(found),
                         std::move(expected), std::move(advice)});
  }

  static double tilt(const Eigen::Quaterniond& start, const Eigen::Quaterniond& q) {
    const Eigen::Vector3d up = start.inverse() * (q * Eigen::Vector3d::UnitZ());
    return std::atan2(up.head<2>().norm(), up.z());
  }

  double tilted_ratio(auto quaternion) const {
    const Eigen::Quaterniond start = quaternion(robot_.odometry.front().pose.rotation());
    double tilted = 0;
    for (const auto& row : robot_.odometry)
      tilted += tilt(start, quaternion(row.pose.rotation())) > kPlanarTilt_rad;
    return tilted / static_cast<double>(robot_.odometry.size());
  }

  /// Whether the quaternions are wrong.
  bool check_quaternions() {
    const double stated = tilted_ratio([](const auto& q) { return q; });
    const double w_first =
        tilted_ratio([](const auto& q) { return Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()); });
    if (stated < 0.2) return false;
    if (w_first < 0.02) {
      add("column-order", Severity::kError,
          "the robot is upside down or on its side in " + number(100 * stated) +
              " % of the poses, and level with qw first",
          "qx qy qz qw", "move the column qw behind qz");
      return true;
    }
    if (is_planar_)
      add("frame", Severity::kWarning, "the robot is tilted in " + number(100 * stated) + " % of the poses",
          "a level robot in a planar mission", "use dimension 3, or a body frame with z up");
    return false;
  }

  Eigen::Vector3d extent_m() const {
    Eigen::Vector3d low = robot_.odometry.front().pose.translation(), high = low;
    for (const auto& row : robot_.odometry) {
      low = low.cwiseMin(row.pose.translation());
      high = high.cwiseMax(row.pose.translation());
    }
    return high - low;
  }

  /// Vertical motion where the vehicle moves on the ground.
  void check_axes() {
    const Eigen::Vector3d extent = extent_m();
    const double flattest = std::min(extent.x(), extent.y());
    if (extent.z() < 5 || flattest > 0.05 * extent.z()) return;
    if (extent.z() < 0.5 * std::max(extent.x(), extent.y())) return;  // a straight road with a slope
    add("column-order", is_planar_ ? Severity::kError : Severity::kWarning,
        "the robot moves " + number(extent.z()) + " m along z and " + number(flattest) + " m along " +
            (extent.x() < extent.y() ? "x" : "y"),
        "z up", "exchange the columns, or turn the frame: cameras have z forward and y down");
  }

  /// Resultant length of the direction of motion in the body frame, |mean exp(i (direction -+ yaw))|.
  void check_heading() {
    std::complex<double> straight, mirrored, yaws;
    double count = 0;
    std::size_t from = 0;
    for (std::size_t k = 1; k < robot_.odometry.size(); ++k) {
      const Eigen::Vector3d step =
          robot_.odometry[k].pose.translation() - robot_.odometry[from].pose.translation();
      if (step.head<2>().norm() < 0.5) continue;
      const double turn = wrap_angle(robot_.odometry[k].pose.yaw() - robot_.odometry[from].pose.yaw());
      const double yaw = robot_.odometry[from].pose.yaw() + 0.5 * turn;
      const double direction = std::atan2(step.y(), step.x());
      from = k;
      if (std::abs(turn) > 0.8) continue;
      straight += std::polar(1.0, direction - yaw);
      mirrored += std::polar(1.0, direction + yaw);
      yaws += std::polar(1.0, 2 * yaw);
      count += 1;
    }
    if (count < 20 || std::abs(yaws) > 0.9 * count) return;  // a straight path looks the same in a mirror
    if (std::abs(mirrored) < 0.85 * count || std::abs(straight) > 0.6 * count) return;
    // Vehicles that reverse may look so, too.
    add("handedness", Severity::kWarning, "the path turns to one side while the yaw turns to the other",
        "a right-handed frame, y to the left of x and yaw counter-clockwise",
        "change the sign of y, exchange x and y, or change the sign of the yaw");
  }

  void check_start() {
    const SE3& first = robot_.odometry.front().pose;
    const double away_m = first.translation().norm();
    if (away_m < 1 && std::abs(first.yaw()) < 0.1) return;
    if (!robot_.initial_pose && away_m < 1e5) return;
    add("frame", Severity::kWarning,
        "the trajectory begins at " + number(away_m) + " m and " + number(degrees(first.yaw())) +
            " degrees from its frame's origin" +
            (robot_.initial_pose ? ", and mission.yaml states where it starts" : ""),
        "the robot's own start frame", "express the trajectory in the frame of its first pose");
  }

  const Robot& robot_;
  bool is_planar_;
  std::vector<Finding>& findings_;
};

}  // namespace

void check_frame(const Mission& mission, const Robot& robot, std::vector<Finding>& findings) {
  FrameCheck(mission, robot, findings).run();
}

}  // namespace radioslam
