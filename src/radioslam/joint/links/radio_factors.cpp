#include "radioslam/joint/links/radio_factors.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/radio/aoa/aoa_likelihood.hpp"

namespace radioslam {
namespace {

constexpr double kMinSigmaAnchor_m = 1e-3;  // lower bound on the error of an anchor's position

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
      const double sigma = std::max(anchor.sigma_m, kMinSigmaAnchor_m);
      factor.information /= sigma * sigma;
      joint_.team.graph.positions.push_back(factor);
    }
  }

  void add(const RangeMeasurement& measured, std::size_t index) {
    if (!covered(measured.i, measured.stamp) || !covered(measured.j, measured.stamp)) {
      ++joint_.ignored_links;
      return;
    }
    RangeFactor<Pose> factor;
    factor.i = end(measured.i, measured.stamp);
    factor.j = end(measured.j, measured.stamp);
    factor.range_m = measured.range_m;
    factor.sigma_m = measured.sigma_m;
    FactorOrigin from = origin(FactorSource::kRange, index, measured.i, measured.j, measured.stamp);
    from.antenna_pair = pairs_.index_of(name(measured.i), name(measured.j));
    add_factor(joint_, factor, from);
  }

  void add(const AoaMeasurement& measured, std::size_t index) {
    const LinkEnd receiver{measured.receiver, {}, {}, Eigen::Vector3d::Zero()};
    if (!covered(receiver, measured.stamp) || !covered(measured.transmitter, measured.stamp)) {
      ++joint_.ignored_links;
      return;
    }
    AmbiguousBearing<Pose> bearing;
    bearing.i = end(receiver, measured.stamp).pose;
    bearing.j = end(measured.transmitter, measured.stamp);
    const SE3 T_start_body = *mission_.robots[measured.receiver.index()].odometry.at(measured.stamp);
    for (const AoaPath& path : as_estimated<Pose>(measured, T_start_body).paths)
      bearing.paths.push_back({unit_vector(path).template head<Pose::kDim>(), path.sigma_rad, path.power_db,
                               !path.elevation_rad});
    add_factor(joint_, std::move(bearing),
               origin(FactorSource::kAoa, index, receiver, measured.transmitter, measured.stamp));
  }

 private:
  bool covered(const LinkEnd& end, Stamp stamp) const {
    return !end.robot.valid() || mission_.robots[end.robot.index()].odometry.covers(stamp);
  }

  RangeEnd<Pose> end(const LinkEnd& end, Stamp stamp) const {
    RangeEnd<Pose> result;
    if (!end.robot.valid()) {
      result.point = PointId(end.anchor.value);
      return result;
    }
    const std::size_t r = end.robot.index();
    result.pose = PoseId(joint_.team.segments[r].first_pose + nodes_[r].node_at(stamp));
    result.lever_arm = end.lever_arm_m.head<Pose::kDim>();
    return result;
  }

  std::string name(const LinkEnd& end) const {
    const std::string& id =
        end.robot.valid() ? mission_.robots[end.robot.index()].id : mission_.anchors[end.anchor.index()].id;
    return end.antenna.empty() ? id : id + "/" + end.antenna;
  }

  /// Origin of a link, by the keyframes before its ends.
  FactorOrigin origin(FactorSource source, std::size_t index, const LinkEnd& i, const LinkEnd& j,
                      Stamp stamp) const {
    const auto keyframe = [&](const LinkEnd& end) {
      return end.robot.valid() ? keyframe_stamp(joint_, end.robot, stamp) : Stamp{};
    };
    return {source, index, i.robot, j.robot, keyframe(i), keyframe(j)};
  }

  JointGraph<Pose>& joint_;
  AntennaPairs pairs_{joint_.antenna_pairs};
  const Mission& mission_;
  const std::vector<RobotNodes>& nodes_;
};

}  // namespace

void add_link_stamps(const Mission& mission, std::vector<std::vector<Stamp>>& node_stamps) {
  const auto note = [&](RobotIndex robot, Stamp stamp) {
    if (robot.valid()) node_stamps[robot.index()].push_back(stamp);
  };
  for (const auto& range : mission.ranges) note(range.i.robot, range.stamp), note(range.j.robot, range.stamp);
  for (const auto& aoa : mission.aoa_measurements)
    note(aoa.receiver, aoa.stamp), note(aoa.transmitter.robot, aoa.stamp);
  for (const auto& match : mission.matches)
    note(match.robot_i, match.stamp_i), note(match.robot_j, match.stamp_j);
}

template <class Pose>
AoaMeasurement as_estimated(const AoaMeasurement& measured, const SE3& T_start_body) {
  if constexpr (Pose::kDim == 2) return levelled(measured, T_start_body);
  return measured;
}

template <class Pose>
void add_radio_factors(JointGraph<Pose>& joint, const Mission& mission,
                       const std::vector<RobotNodes>& nodes) {
  RadioFactors<Pose> factors(joint, mission, nodes);
  factors.add_anchors();
  for (std::size_t k = 0; k < mission.ranges.size(); ++k) factors.add(mission.ranges[k], k);
  for (std::size_t k = 0; k < mission.aoa_measurements.size(); ++k)
    factors.add(mission.aoa_measurements[k], k);
}

template AoaMeasurement as_estimated<SE2>(const AoaMeasurement&, const SE3&);
template AoaMeasurement as_estimated<SE3>(const AoaMeasurement&, const SE3&);
template void add_radio_factors(JointGraph<SE2>&, const Mission&, const std::vector<RobotNodes>&);
template void add_radio_factors(JointGraph<SE3>&, const Mission&, const std::vector<RobotNodes>&);

}  // namespace radioslam
