#include "radioslam/study/distributed_optimization/simulated_teams.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kSigma_m = 0.05, kSigma_rad = 0.01;  ///< of every relative pose, per axis
constexpr double kHill_m = 2, kHillLength_m = 25;     ///< of the ground

using Drive = std::vector<SE3>;

/// On hilly ground, at an angle to it.
SE3 place_on_ground(double x_m, double y_m, double yaw_rad) {
  const double slope = kHill_m / kHillLength_m;
  const Eigen::Vector3d p(x_m, y_m, kHill_m * std::sin(x_m / kHillLength_m) * std::cos(y_m / kHillLength_m));
  const Eigen::AngleAxisd yaw(yaw_rad, Eigen::Vector3d::UnitZ());
  return {p, yaw * Eigen::AngleAxisd(slope, Eigen::Vector3d::UnitX()) *
                 Eigen::AngleAxisd(-slope * std::cos(x_m / kHillLength_m), Eigen::Vector3d::UnitY())};
}

RelativePoseFactor<SE3> measure(const std::vector<SE3>& truth, std::size_t i, std::size_t j, Rng& rng) {
  SE3::Tangent sigma, noise;
  sigma << SE3::Point::Constant(kSigma_m), SE3::Point::Constant(kSigma_rad);
  for (Eigen::Index k = 0; k < noise.size(); ++k) noise[k] = rng.normal(0, sigma[k]);
  RelativePoseFactor<SE3> factor{PoseId(i), PoseId(j), truth[i].inverse() * truth[j] * SE3::exp(noise)};
  factor.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  return factor;
}

/// Odometry along the drives, and of the pairs of other places within `reach_m` a share.
TeamGraph<SE3> measure_drives(const std::vector<Drive>& drives, double reach_m, double share, Rng rng) {
  TeamGraph<SE3> team;
  Drive truth;
  std::vector<bool> follows;  ///< on another pose of the robot
  for (const Drive& drive : drives) {
    team.segments.push_back({std::to_string(team.segments.size()), truth.size(), drive.size(), {}});
    for (std::size_t k = 0; k < drive.size(); ++k) {
      const std::size_t pose = truth.size();
      truth.push_back(drive[k]);
      follows.push_back(k > 0);
      if (k == 0) {
        team.graph.poses.emplace_back();
        continue;
      }
      team.graph.relative_poses.push_back(measure(truth, pose - 1, pose, rng));
      team.graph.poses.push_back(team.graph.poses.back() * team.graph.relative_poses.back().T_i_j);
    }
  }
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (std::size_t j = i + 1; j < truth.size(); ++j) {
      if (j == i + 1 && follows[j]) continue;
      if ((truth[i].translation() - truth[j].translation()).head<2>().norm() > reach_m) continue;
      if (rng.uniform() < share) team.graph.relative_poses.push_back(measure(truth, i, j, rng));
    }
  return team;
}

}  // namespace

TeamGraph<SE3> simulate_blocks(std::size_t rows, std::size_t columns, std::size_t side, std::uint64_t seed) {
  constexpr double kReach_m = 1.1, kShare = 0.3;
  const std::size_t between = side - side / 3;
  std::vector<Drive> drives;
  for (std::size_t robot = 0; robot < rows * columns; ++robot) {
    Drive& drive = drives.emplace_back();
    for (std::size_t k = 0; k < side * side; ++k) {
      const std::size_t row = k / side;
      const bool back = row % 2 == 1;
      const std::size_t column = back ? side - 1 - k % side : k % side;
      drive.push_back(place_on_ground(double(robot % columns * between + column),
                                      double(robot / columns * between + row), back ? std::numbers::pi : 0));
    }
  }
  return measure_drives(drives, kReach_m, kShare, Rng(seed).split("blocks"));
}

TeamGraph<SE3> simulate_laps(std::size_t robots, std::uint64_t seed) {
  constexpr double kRadius_m = 60, kBetween_m = 95, kStep_m = 1.5, kReach_m = 2, kShare = 0.5;
  constexpr double kStep_rad = kStep_m / kRadius_m, kDriven_rad = 2 * std::numbers::pi + 4 * kStep_rad;
  const std::size_t columns = robots == 2 ? 2 : (robots + 1) / 2;
  std::vector<Drive> drives;
  for (std::size_t robot = 0; robot < robots; ++robot) {
    Drive& drive = drives.emplace_back();
    const double x_m = kBetween_m * double(robot % columns), y_m = kBetween_m * double(robot / columns);
    for (double angle = double(robot); angle < double(robot) + kDriven_rad; angle += kStep_rad)
      drive.push_back(place_on_ground(x_m + kRadius_m * std::cos(angle), y_m + kRadius_m * std::sin(angle),
                                      angle + std::numbers::pi / 2));
  }
  return measure_drives(drives, kReach_m, kShare, Rng(seed).split("laps"));
}

}  // namespace radioslam
