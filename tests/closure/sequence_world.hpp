// Robots whose fingerprint similarity is exactly exp(-d / 20 m) of their true distance, with a distance model
// trained on that law and perfect odometry.
#pragma once

#include <cmath>
#include <vector>

#include "radioslam/closure/sequence_window.hpp"

namespace radioslam {

inline constexpr double kSimilarityLength_m = 20;

inline double similarity_at(double distance_m) { return std::exp(-distance_m / kSimilarityLength_m); }

inline DistanceModel lawful_model() {
  constexpr double kStep_m = 0.02, kFarthest_m = 80;
  std::vector<DistanceSample> samples;
  for (double d = 0; d < kFarthest_m; d += kStep_m) samples.push_back({similarity_at(d), d});
  return DistanceModel(std::move(samples), {});
}

/// Robots with a fingerprint at each of these poses, given in one frame. Each robot's odometry starts at its
/// first pose.
inline RadioMeasurements lawful_radio(const std::vector<std::vector<SE2>>& robots) {
  RadioMeasurements radio{{}, {}, {}, {}, lawful_model(), {}, {}, {}};
  std::vector<Eigen::Vector2d> places;
  for (std::size_t r = 0; r < robots.size(); ++r) {
    radio.robots.emplace_back();
    double travelled_m = 0;
    for (std::size_t k = 0; k < robots[r].size(); ++k) {
      if (k > 0) travelled_m += (robots[r][k].translation() - robots[r][k - 1].translation()).norm();
      PlacedFingerprint placed{{}, lift(robots[r].front().inverse() * robots[r][k]), travelled_m};
      placed.fingerprint.stamp = Stamp::from_seconds(static_cast<double>(k));
      radio.robots[r].push_back(placed);
      radio.nodes.push_back({RobotIndex(r), k});
      places.push_back(robots[r][k].translation());
    }
  }
  std::vector<std::vector<float>> similarity;
  for (const auto& a : places) {
    std::vector<float> row;
    for (const auto& b : places) row.push_back(static_cast<float>(similarity_at((a - b).norm())));
    similarity.push_back(std::move(row));
  }
  radio.near_similarity = TeamSimilarity(std::move(similarity));
  return radio;
}

/// A path from (x, y) with this heading and a fingerprint every 2 m; halfway it turns left by
/// `max_deviation_rad`.
inline std::vector<SE2> bent_way(double x_m, double y_m, double yaw_rad, std::size_t fingerprints,
                                 double max_deviation_rad) {
  constexpr double kStep_m = 2;
  std::vector<SE2> path{SE2({x_m, y_m}, yaw_rad)};
  for (std::size_t k = 1; k < fingerprints; ++k) {
    const double turn = k == fingerprints / 2 ? max_deviation_rad : 0;
    path.push_back(path.back() * SE2({kStep_m, 0}, turn));
  }
  return path;
}

/// The same positions in the opposite direction.
inline std::vector<SE2> driven_back(const std::vector<SE2>& path) {
  std::vector<SE2> back;
  for (auto pose = path.rbegin(); pose != path.rend(); ++pose)
    back.push_back(SE2(pose->translation(), pose->angle() + 3.14159265358979));
  return back;
}

}  // namespace radioslam
