#include "radioslam/pipeline/radio_factors.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/pipeline/antenna_pairs.hpp"
#include "radioslam/radio/arrival_likelihood.hpp"

namespace radioslam {
namespace {

constexpr double kLeastSigmaAnchor_m = 1e-3;  // an anchor's place is never exact

template <class Pose>
class RadioFactors {
 public:
  RadioFactors(JointGraph<Pose>& joint, const Mission& mission, const std::vector<RobotNodes>& nodes)
      : joint_(joint), mission_(mission), nodes_(nodes) {}

  void add_anchors() {
    for (const Anchor& anchor : mission_.anchors) {
      const PointId id(joint_.team.graph.points.size());
      joint_.team.graph.points.push_back(typename Pose::Point(
          anchor.position_m.value_or(Eigen::Vector3d::Zero()).template head<Pose::kDim>()));
      if (!anchor.position_m) continue;
      PositionFactor<Pose> factor;
      factor.i.point = id;
      factor.position = joint_.team.graph.points.back();
      const double sigma = std::max(anchor.sigma_m, kLeastSigmaAnchor_m);
      factor.information /= sigma * sigma;
      joint_.team.graph.positions.push_back(factor);
    }
  }

  void add(const RangeMeasurement& measured) {
    if (!covered(measured.i, measured.stamp) || !covered(measured.j, measured.stamp)) {
      ++joint_.ignored_links;
      return;
    }
    RangeFactor<Pose> factor;
    factor.i = end(measured.i, measured.stamp);
    factor.j = end(measured.j, measured.stamp);
    factor.range_m = measured.range_m;
    factor.sigma_m = measured.sigma_m;
    joint_.team.graph.ranges.push_back(factor);
    joint_.range_ties.push_back(tie(measured.i, measured.j, measured.stamp));
    joint_.range_pairs.push_back(pairs_.index_of(name(measured.i), name(measured.j)));
  }

  void add(const ArrivalMeasurement& measured) {
    const RadioEnd receiver{measured.receiver, {}, {}, Eigen::Vector3d::Zero()};
    if (!covered(receiver, measured.stamp) || !covered(measured.transmitter, measured.stamp)) {
      ++joint_.ignored_links;
      return;
    }
    AmbiguousBearing<Pose> bearing;
    bearing.i = end(receiver, measured.stamp).pose;
    bearing.j = end(measured.transmitter, measured.stamp);
    const SE3 T_start_body = *mission_.robots[measured.receiver.index()].odometry.at(measured.stamp);
    for (const ArrivalPath& path : as_estimated<Pose>(measured, T_start_body).paths)
      bearing.paths.push_back({unit_vector(path).template head<Pose::kDim>(), path.sigma_rad, path.power_db});
    joint_.team.bearings.push_back(std::move(bearing));
    joint_.bearing_ties.push_back(tie(receiver, measured.transmitter, measured.stamp));
  }

 private:
  bool covered(const RadioEnd& end, Stamp stamp) const {
    return !end.robot.valid() || mission_.robots[end.robot.index()].odometry.covers(stamp);
  }

  RangeEnd<Pose> end(const RadioEnd& end, Stamp stamp) const {
    RangeEnd<Pose> result;
    if (!end.robot.valid()) {
      result.point = PointId(end.anchor.value);
      return result;
    }
    const std::size_t r = end.robot.index();
    result.pose = PoseId(joint_.team.pieces[r].first_pose + nodes_[r].node_at(stamp));
    result.lever_arm = end.lever_arm_m.head<Pose::kDim>();
    return result;
  }

  std::string name(const RadioEnd& end) const {
    const std::string& id =
        end.robot.valid() ? mission_.robots[end.robot.index()].id : mission_.anchors[end.anchor.index()].id;
    return end.antenna.empty() ? id : id + "/" + end.antenna;
  }

  /// Told by the keyframes before it.
  RadioTie tie(const RadioEnd& i, const RadioEnd& j, Stamp stamp) const {
    const auto keyframe = [&](const RadioEnd& end) {
      if (!end.robot.valid()) return Stamp{};
      const auto& stamps = joint_.robots[end.robot.index()].stamps;
      return stamps[keyframe_before(stamps, stamp)];
    };
    return {i.robot, j.robot, keyframe(i), keyframe(j)};
  }

  JointGraph<Pose>& joint_;
  AntennaPairs pairs_{joint_.antenna_pairs};
  const Mission& mission_;
  const std::vector<RobotNodes>& nodes_;
};

}  // namespace

void add_link_moments(const Mission& mission, std::vector<std::vector<Stamp>>& moments) {
  const auto note = [&](RobotIndex robot, Stamp stamp) {
    if (robot.valid()) moments[robot.index()].push_back(stamp);
  };
  for (const auto& range : mission.ranges) note(range.i.robot, range.stamp), note(range.j.robot, range.stamp);
  for (const auto& arrival : mission.arrivals)
    note(arrival.receiver, arrival.stamp), note(arrival.transmitter.robot, arrival.stamp);
  for (const auto& match : mission.matches)
    note(match.robot_i, match.stamp_i), note(match.robot_j, match.stamp_j);
}

template <class Pose>
ArrivalMeasurement as_estimated(const ArrivalMeasurement& measured, const SE3& T_start_body) {
  if constexpr (Pose::kDim == 2) return levelled(measured, T_start_body);
  return measured;
}

template <class Pose>
void add_radio_factors(JointGraph<Pose>& joint, const Mission& mission,
                       const std::vector<RobotNodes>& nodes) {
  RadioFactors<Pose> factors(joint, mission, nodes);
  factors.add_anchors();
  for (const auto& range : mission.ranges) factors.add(range);
  for (const auto& arrival : mission.arrivals) factors.add(arrival);
}

template ArrivalMeasurement as_estimated<SE2>(const ArrivalMeasurement&, const SE3&);
template ArrivalMeasurement as_estimated<SE3>(const ArrivalMeasurement&, const SE3&);
template void add_radio_factors(JointGraph<SE2>&, const Mission&, const std::vector<RobotNodes>&);
template void add_radio_factors(JointGraph<SE3>&, const Mission&, const std::vector<RobotNodes>&);

}  // namespace radioslam
