#include "radioslam/joint/links/radio_factors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "radioslam/joint/keyframe_poses.hpp"
#include "radioslam/radio/aoa/aoa_likelihood.hpp"

namespace radioslam {
namespace {

constexpr double kMinSigmaAnchor_m = 1e-3;  // lower bound on the error of an anchor's position

template <class Pose>
class RadioFactors {
 public:
  RadioFactors(JointGraph<Pose>& joint, const Mission& mission)
      : joint_(joint), mission_(mission), poses_(joint, mission) {}

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
    const auto i = end(measured.i, measured.stamp), j = end(measured.j, measured.stamp);
    if (!i || !j) {
      ++joint_.ignored_links;
      return;
    }
    RangeFactor<Pose> factor;
    factor.i = i->end;
    factor.j = j->end;
    factor.after_ns = factor.i.pose.valid() ? i->after_ns : j->after_ns;
    factor.range_m = measured.range_m;
    factor.sigma_m = std::sqrt(measured.sigma_m * measured.sigma_m + i->variance_m2 + j->variance_m2);
    FactorOrigin from = origin(FactorSource::kRange, index, measured.i, measured.j, measured.stamp);
    from.antenna_pair = pairs_.index_of(name(measured.i), name(measured.j));
    add_factor(joint_, factor, from);
  }

  void add(const AoaMeasurement& measured, std::size_t index) {
    const auto at_receiver = poses_.at(measured.receiver, measured.stamp);
    const auto transmitter = end(measured.transmitter, measured.stamp);
    if (!at_receiver || !transmitter) {
      ++joint_.ignored_links;
      return;
    }
    AmbiguousBearing<Pose> bearing;
    bearing.i = at_receiver->pose;
    bearing.T_i_receiver = at_receiver->motion.T_keyframe_body.pose;
    bearing.after_ns = at_receiver->after_ns;
    bearing.j = transmitter->end;
    const SE3 T_start_body = *mission_.robots[measured.receiver.index()].odometry.at(measured.stamp);
    for (const AoaPath& path : as_estimated<Pose>(measured, T_start_body).paths)
      bearing.paths.push_back(
          {unit_vector(path).template head<Pose::kDim>(),
           std::sqrt(path.sigma_rad * path.sigma_rad + at_receiver->motion.rotation_rad2()), path.power_db,
           !path.elevation_rad});
    const LinkEnd receiver{measured.receiver, {}, {}, Eigen::Vector3d::Zero()};
    add_factor(joint_, std::move(bearing),
               origin(FactorSource::kAoa, index, receiver, measured.transmitter, measured.stamp));
  }

 private:
  /// On the keyframe before it.
  struct End {
    RangeEnd<Pose> end;
    double variance_m2 = 0;  ///< of the position there, by the odometry since
    std::int64_t after_ns = 0;
  };

  std::optional<End> end(const LinkEnd& end, Stamp stamp) {
    if (!end.robot.valid()) return End{{{}, PointId(end.anchor.value)}};
    const auto at = poses_.at(end.robot, stamp);
    if (!at) return std::nullopt;
    const Pose& T_keyframe_body = at->motion.T_keyframe_body.pose;
    return End{{at->pose, {}, T_keyframe_body * end.lever_arm_m.head<Pose::kDim>()},
               at->motion.position_m2(),
               at->after_ns};
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
  KeyframePoses<Pose> poses_;
};

}  // namespace

template <class Pose>
AoaMeasurement as_estimated(const AoaMeasurement& measured, const SE3& T_start_body) {
  if constexpr (Pose::kDim == 2) return levelled(measured, T_start_body);
  return measured;
}

template <class Pose>
void add_radio_factors(JointGraph<Pose>& joint, const Mission& mission) {
  RadioFactors<Pose> factors(joint, mission);
  factors.add_anchors();
  for (std::size_t k = 0; k < mission.ranges.size(); ++k) factors.add(mission.ranges[k], k);
  for (std::size_t k = 0; k < mission.aoa_measurements.size(); ++k)
    factors.add(mission.aoa_measurements[k], k);
}

template AoaMeasurement as_estimated<SE2>(const AoaMeasurement&, const SE3&);
template AoaMeasurement as_estimated<SE3>(const AoaMeasurement&, const SE3&);
template void add_radio_factors(JointGraph<SE2>&, const Mission&);
template void add_radio_factors(JointGraph<SE3>&, const Mission&);

}  // namespace radioslam
