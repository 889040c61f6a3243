// Whether ground truth fits the odometry: on its clock, and not as its mirror image.
//
// Both are cut into stretches in which dead reckoning is nearly exact. In each the odometry is carried onto
// the truth by the best rigid motion of the plane, as recorded and mirrored; straight stretches are their own
// mirror images and count for neither.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "radioslam/doctor/check_mission.hpp"
#include "radioslam/doctor/team_links.hpp"
#include "radioslam/doctor/text.hpp"
#include "radioslam/geometry/alignment.hpp"

namespace radioslam {
namespace {

constexpr double kStretch_m = 80;
constexpr double kMaxRatio = 0.4;          // of the mirrored fit's RMSE to that as recorded
constexpr double kMinRatioToExtent = 0.1;  // of the RMSE as recorded
constexpr std::size_t kMinPlaces = 4;

/// Places by odometry and truth at the same times.
struct Stretch {
  std::vector<Eigen::Vector2d> odometry_m, truth_m;
};

std::vector<Stretch> stretches_of(const Track& track, const RobotTruth& truth) {
  std::vector<Stretch> stretches(1);
  double end_m = kStretch_m;
  for (const auto& row : truth.poses) {
    const auto at = track.at(row.stamp.seconds());
    if (!at) continue;
    if (at->path_m > end_m) {
      stretches.emplace_back();
      end_m = at->path_m + kStretch_m;
    }
    stretches.back().odometry_m.push_back(at->position_m.head<2>());
    stretches.back().truth_m.push_back(row.pose.translation().head<2>());
  }
  std::erase_if(stretches, [](const Stretch& stretch) { return stretch.truth_m.size() < kMinPlaces; });
  return stretches;
}

Eigen::Matrix2Xd columns(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Matrix2Xd matrix(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) matrix.col(static_cast<Eigen::Index>(k)) = points[k];
  return matrix;
}

double squared_misfit(const Eigen::Matrix2Xd& odometry, const Eigen::Matrix2Xd& truth) {
  const SE2 T_truth_odometry = align_points(odometry, truth);
  double sum = 0;
  for (Eigen::Index k = 0; k < truth.cols(); ++k)
    sum += (truth.col(k) - T_truth_odometry * Eigen::Vector2d(odometry.col(k))).squaredNorm();
  return sum;
}

struct Misfit {
  double as_recorded = 0, mirrored = 0, extent = 0, count = 0;  ///< squared, summed
  double metres(double squared) const { return std::sqrt(squared / count); }
};

Misfit misfit_of(const std::vector<Stretch>& stretches) {
  Misfit misfit;
  for (const Stretch& stretch : stretches) {
    Eigen::Matrix2Xd odometry = columns(stretch.odometry_m);
    const Eigen::Matrix2Xd truth = columns(stretch.truth_m);
    misfit.as_recorded += squared_misfit(odometry, truth);
    odometry.row(1) *= -1;
    misfit.mirrored += squared_misfit(odometry, truth);
    misfit.extent += (truth.colwise() - truth.rowwise().mean()).squaredNorm();
    misfit.count += static_cast<double>(truth.cols());
  }
  return misfit;
}

void check_robot(const Robot& robot, const RobotTruth& truth, std::vector<Finding>& findings) {
  const auto add = [&](const char* kind, std::string found, std::string expected, std::string advice) {
    findings.push_back({kind, Severity::kWarning, robot.id, robot_file(robot.id, "groundtruth.tum"),
                        std::move(found), std::move(expected), std::move(advice)});
  };
  const double begin_s = robot.odometry.front().stamp.seconds(),
               end_s = robot.odometry.back().stamp.seconds();
  const double first_s = truth.poses.front().stamp.seconds(), last_s = truth.poses.back().stamp.seconds();
  if (first_s > end_s || last_s < begin_s)
    return add("clock", "times from " + time_text(first_s) + " to " + time_text(last_s) + " s",
               "the clock of the odometry, " + time_text(begin_s) + " to " + time_text(end_s) + " s",
               "no error can be evaluated until both are on one clock");
  const Misfit misfit = misfit_of(stretches_of(Track(robot), truth));
  if (misfit.as_recorded <= kMinRatioToExtent * kMinRatioToExtent * misfit.extent ||
      misfit.mirrored >= kMaxRatio * kMaxRatio * misfit.as_recorded)
    return;
  add("handedness",
      "the ground truth fits the odometry only as a mirror image (" + number(misfit.metres(misfit.mirrored)) +
          " m rmse over " + number(kStretch_m) + " m, " + number(misfit.metres(misfit.as_recorded)) +
          " m without reflection)",
      "both in right-handed frames, y to the left of x", "change the sign of y, or exchange x and y, of one");
}

}  // namespace

std::vector<Finding> check_truth(const Mission& mission, const Truth& truth) {
  std::vector<Finding> findings;
  for (std::size_t r = 0; r < std::min(mission.robots.size(), truth.robots.size()); ++r)
    if (!mission.robots[r].odometry.empty() && !truth.robots[r].poses.empty())
      check_robot(mission.robots[r], truth.robots[r], findings);
  return findings;
}

}  // namespace radioslam
