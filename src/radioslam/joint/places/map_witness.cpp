#include "radioslam/joint/places/map_witness.hpp"

#include <cmath>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/joint/places/scanned_robot.hpp"

namespace radioslam {
MapWitness::MapWitness(const Mission& mission, const MeasuredScans& scans)
    : mission_(mission), scans_(scans) {
  for (const auto& robot : scans.robots)
    path_m_.push_back(robot ? path_lengths(robot->keyframes) : std::vector<double>());
}

SeenThrough MapWitness::held_against(const std::vector<const Closure*>& closures) const {
  const RobotIndex a = closures.front()->robot_i, b = closures.front()->robot_j;
  if (a == b) return {};
  std::vector<SharedPlace> places;
  for (const Closure* closure : closures) {
    const bool forward = closure->robot_i == a;
    const SE3 T_a_b = forward ? closure->T_i_j : closure->T_i_j.inverse();
    const auto at_a = from_keyframe(a, forward ? closure->stamp_i : closure->stamp_j),
               at_b = from_keyframe(b, forward ? closure->stamp_j : closure->stamp_i);
    if (!at_a || !at_b) continue;
    const Eigen::Matrix3d covariance = inverse(closure->information).topLeftCorner<3, 3>();
    places.push_back({at_a->first, at_b->first, at_a->second * T_a_b * at_b->second.inverse(),
                      std::sqrt(covariance.diagonal().maxCoeff())});
  }
  return places.empty() ? SeenThrough{} : seen_through(placed(a.index()), placed(b.index()), places);
}

PlacedKeyframes MapWitness::placed(std::size_t robot) const {
  return placed_keyframes(*scans_.robots[robot], path_m_[robot]);
}

std::optional<std::pair<std::size_t, SE3>> MapWitness::from_keyframe(RobotIndex robot, Stamp stamp) const {
  const std::size_t r = robot.index();
  if (r >= scans_.robots.size() || !scans_.robots[r] || scans_.robots[r]->keyframe_stamps.empty())
    return std::nullopt;
  const std::vector<Stamp>& stamps = scans_.robots[r]->keyframe_stamps;
  const std::size_t k = keyframe_before(stamps, stamp);
  const auto at_keyframe = mission_.robots[r].odometry.at(stamps[k]),
             at = mission_.robots[r].odometry.at(stamp);
  if (!at_keyframe || !at) return std::nullopt;
  return std::pair{k, at_keyframe->inverse() * *at};
}

}  // namespace radioslam
