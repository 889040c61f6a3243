// Whether ground truth fits the odometry: on its clock, and not as its mirror image.
//
// Both are cut into stretches in which dead reckoning is nearly exact. In each the odometry is carried onto
// the truth by the best rigid motion, as recorded and mirrored; straight stretches are their own mirror
// images and count for neither. In space so are plane ones: a frame that is turned over is no mirror image.
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
  std::vector<Eigen::Vector3d> odometry_m, truth_m;
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
    stretches.back().odometry_m.push_back(at->position_m);
    stretches.back().truth_m.push_back(row.pose.translation());
  }
  std::erase_if(stretches, [](const Stretch& stretch) { return stretch.truth_m.size() < kMinPlaces; });
  return stretches;
}

/// `dimension` 2 or 3: in the plane without heights.
template <int dimension>
Eigen::Matrix<double, dimension, Eigen::Dynamic> columns(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix<double, dimension, Eigen::Dynamic> matrix(dimension,
                                                          static_cast<Eigen::Index>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k)
    matrix.col(static_cast<Eigen::Index>(k)) = points[k].template head<dimension>();
  return matrix;
}

template <class Points>
double squared_misfit(const Points& odometry, const Points& truth) {
  const auto T_truth_odometry = align_points(odometry, truth);
  double sum = 0;
  for (Eigen::Index k = 0; k < truth.cols(); ++k) {
    const Eigen::Vector<double, Points::RowsAtCompileTime> place = odometry.col(k);
    sum += (truth.col(k) - T_truth_odometry * place).squaredNorm();
  }
  return sum;
}

struct Misfit {
  double as_recorded = 0, mirrored = 0, extent = 0, count = 0;  ///< squared, summed
  double metres(double squared) const { return std::sqrt(squared / count); }
};

template <int dimension>
Misfit misfit_of(const std::vector<Stretch>& stretches) {
  Misfit misfit;
  for (const Stretch& stretch : stretches) {
    auto odometry = columns<dimension>(stretch.odometry_m);
    const auto truth = columns<dimension>(stretch.truth_m);
    misfit.as_recorded += squared_misfit(odometry, truth);
    odometry.row(1) *= -1;
    misfit.mirrored += squared_misfit(odometry, truth);
    misfit.extent += (truth.colwise() - truth.rowwise().mean()).squaredNorm();
    misfit.count += static_cast<double>(truth.cols());
  }
  return misfit;
}

void check_robot(const Robot& robot, const RobotTruth& truth, int dimension, std::vector<Finding>& findings) {
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
  const auto stretches = stretches_of(Track(robot), truth);
  const Misfit misfit = dimension == 3 ? misfit_of<3>(stretches) : misfit_of<2>(stretches);
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
      check_robot(mission.robots[r], truth.robots[r], mission.dimension, findings);
  return findings;
}

}  // namespace radioslam
