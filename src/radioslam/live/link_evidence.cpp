#include "radioslam/live/link_evidence.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {

template <class Pose>
std::size_t unjoined_links(const Mission& logged, const TeamEstimate<Pose>* team) {
  std::map<std::pair<int, int>, std::size_t> links;
  std::vector<int> frame(logged.robots.size());
  const bool is_aligned = team && !team->alignment.segments.of_segment.empty();
  for (std::size_t r = 0; r < logged.robots.size(); ++r) {
    frame[r] = -1 - static_cast<int>(r);
    if (!is_aligned) continue;
    const auto& robots = team->joint.robots;
    for (std::size_t p = 0; p < team->joint.robot_of_segment.size(); ++p) {
      const bool is_of_robot = robots[team->joint.robot_of_segment[p]].id == logged.robots[r].id;
      if (is_of_robot && frame[r] < 0) frame[r] = team->alignment.segments.of_segment[p];
    }
  }
  const auto add = [&](RobotIndex i, RobotIndex j) {
    if (i.valid() && j.valid() && frame[i.index()] != frame[j.index()])
      ++links[std::minmax(frame[i.index()], frame[j.index()])];
  };
  for (const RangeMeasurement& range : logged.ranges) add(range.i.robot, range.j.robot);
  for (const AoaMeasurement& angles : logged.aoa_measurements) add(angles.receiver, angles.transmitter.robot);
  std::size_t most = 0;
  for (const auto& [pair, count] : links) most = std::max(most, count);
  return most;
}

template <class Pose>
bool fits_worse_of_late(const TeamEstimate<Pose>& team) {
  constexpr std::size_t kLate = 10;
  const JointGraph<Pose>& joint = team.joint;
  const auto segment_of = segment_of_poses(joint.team);
  const auto& frames = team.alignment.segments.of_segment;
  if (frames.empty()) return false;
  std::vector<std::pair<Stamp, double>> weights;
  const auto add = [&](const FactorOrigin& origin, double weight) {
    const auto frame = [&](RobotIndex robot) {
      return frames[segment_of[joint.robots[robot.index()].poses.front().index()]];
    };
    if (origin.robot_i.valid() && origin.robot_j.valid() && frame(origin.robot_i) == frame(origin.robot_j))
      weights.emplace_back(origin.stamp_i, weight);
  };
  for (const std::size_t k : factors_of(joint.origins.ranges, FactorSource::kRange))
    add(joint.origins.ranges[k], joint.team.graph.ranges[k].weight);
  for (std::size_t k = 0; k < joint.bearing_weights.size(); ++k)
    add(joint.origins.bearings[k], joint.bearing_weights[k].weight);
  if (weights.size() < 2 * kLate) return false;
  std::stable_sort(weights.begin(), weights.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto mean = [&](std::size_t from) {
    double sum = 0;
    for (std::size_t k = from; k < weights.size(); ++k) sum += weights[k].second;
    return sum / static_cast<double>(weights.size() - from);
  };
  return mean(weights.size() - kLate) < 0.5 * mean(0);
}

#define RADIOSLAM_LINK_EVIDENCE(Pose)                                             \
  template std::size_t unjoined_links(const Mission&, const TeamEstimate<Pose>*); \
  template bool fits_worse_of_late(const TeamEstimate<Pose>&);
RADIOSLAM_LINK_EVIDENCE(SE2)
RADIOSLAM_LINK_EVIDENCE(SE3)
#undef RADIOSLAM_LINK_EVIDENCE

}  // namespace radioslam
