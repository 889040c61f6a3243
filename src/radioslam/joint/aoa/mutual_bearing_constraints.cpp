#include "radioslam/joint/aoa/mutual_bearing_constraints.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/graph/marginals.hpp"

namespace radioslam {
namespace {

constexpr double kDirectWeight = 0.5;  // min. weight of a range or path that is used as direct
constexpr int kMotionRounds = 5;       // of turning directions from their time to the range's

/// Robot, keyframe and stamp of a pose of the graph.
struct PoseOrigin {
  std::size_t robot = 0, keyframe = 0;  ///< the last keyframe not after the pose
  Stamp stamp;
};

template <class Pose>
class PoseOrigins {
 public:
  explicit PoseOrigins(const JointGraph<Pose>& joint) : origins_(joint.team.graph.poses.size()) {
    for (std::size_t p = 0; p < joint.team.segments.size(); ++p) {
      const TrajectorySegment& segment = joint.team.segments[p];
      const std::size_t r = joint.robot_of_segment[p];
      for (std::size_t k = 0; k < segment.pose_count; ++k)
        origins_[segment.first_pose + k] = {r, keyframe_before(joint.robots[r].stamps, segment.stamps[k]),
                                            segment.stamps[k]};
    }
  }
  const PoseOrigin& of(PoseId pose) const { return origins_[pose.index()]; }

 private:
  std::vector<PoseOrigin> origins_;
};

template <class Pose>
std::vector<KeyframeOdometry<Pose>> odometry_chains(const JointGraph<Pose>& joint,
                                                    const PoseOrigins<Pose>& origins) {
  std::vector<KeyframeOdometry<Pose>> chains(joint.robots.size());
  for (std::size_t r = 0; r < chains.size(); ++r)
    for (const SE3& pose : joint.robots[r].odometry) chains[r].poses.push_back(pose_as<Pose>(pose));
  for (auto& chain : chains)
    chain.cov_steps.resize(chain.poses.empty() ? 0 : chain.poses.size() - 1, Pose::Jacobian::Zero());
  for (const std::size_t k : factors_of(joint.origins.relative_poses, FactorSource::kOdometry)) {
    const auto& factor = joint.team.graph.relative_poses[k];
    const PoseOrigin& i = origins.of(factor.i);
    if (i.keyframe >= chains[i.robot].cov_steps.size()) continue;
    auto& sum = chains[i.robot].cov_steps[i.keyframe];
    const typename Pose::Jacobian carry = factor.T_i_j.inverse().adjoint();
    sum = congruence(carry, sum, inverse(factor.information));
  }
  return chains;
}

/// Whether the factor is of one of the bearing's paths. Several bearings of one pair of poses differ in where
/// the receiver was.
template <class Pose>
bool is_path_of(const BearingFactor<Pose>& factor, const AmbiguousBearing<Pose>& bearing) {
  return factor.i == bearing.i && factor.j.pose == bearing.j.pose &&
         factor.T_i_receiver.translation() == bearing.T_i_receiver.translation() &&
         factor.T_i_receiver.rotation_matrix() == bearing.T_i_receiver.rotation_matrix() &&
         std::any_of(bearing.paths.begin(), bearing.paths.end(),
                     [&](const auto& path) { return path.direction == factor.direction; });
}

/// The most likely direct path of a bearing, by its weight in the graph.
template <class Pose>
const BearingFactor<Pose>* direct_path(const PoseGraph<Pose>& graph, const AmbiguousBearing<Pose>& bearing) {
  const BearingFactor<Pose>* best = nullptr;
  for (const auto& factor : graph.bearings)
    if (factor.weight >= kDirectWeight && (!best || factor.weight > best->weight) &&
        is_path_of(factor, bearing))
      best = &factor;
  return best;
}

template <class Pose>
class MutualBearings {
 public:
  MutualBearings(const JointGraph<Pose>& joint, const PoseOrigins<Pose>& origins, double pairing_s)
      : joint_(joint), origins_(origins), pairing_s_(pairing_s) {}

  /// Ranges with a direct angle at both ends. Only in the plane: two azimuths leave roll and pitch
  /// unobservable.
  std::vector<OverlapLink<Pose>> from_mutual_bearings() const {
    std::vector<OverlapLink<Pose>> links;
    if constexpr (Pose::kDim == 2) {
      const auto& graph = joint_.team.graph;
      for (const std::size_t k : radio_ranges()) {
        const auto& range = graph.ranges[k];
        if (!range.i.pose.valid() || !range.j.pose.valid() || range.weight < kDirectWeight) continue;
        const Stamp stamp{origins_.of(range.i.pose).stamp.ns + range.after_ns};
        const auto* seen_by_i = nearest_bearing(range.i.pose, range.j.pose, stamp);
        const auto* seen_by_j = nearest_bearing(range.j.pose, range.i.pose, stamp);
        if (seen_by_i && seen_by_j) links.push_back(link(range, *seen_by_i, *seen_by_j));
      }
    }
    return links;
  }

  /// For missions without such links: relative poses of the joint estimate, at its radio links.
  std::vector<OverlapLink<Pose>> estimated() const {
    std::vector<OverlapLink<Pose>> links;
    const auto marginals = Marginals<Pose>::compute(joint_.team.graph);
    if (!marginals) return links;
    std::set<std::pair<PoseId, PoseId>> added;
    const auto add = [&](PoseId i, PoseId j) {
      if (!i.valid() || !j.valid() || origins_.of(i).robot == origins_.of(j).robot) return;
      if (!added.emplace(i, j).second) return;
      const auto& graph = joint_.team.graph;
      links.push_back(at_keyframes(i, j, graph.poses[i.index()].inverse() * graph.poses[j.index()],
                                   marginals->relative_pose(i, j)));
    };
    for (const std::size_t k : radio_ranges())
      add(joint_.team.graph.ranges[k].i.pose, joint_.team.graph.ranges[k].j.pose);
    if (radio_ranges().empty())
      for (const auto& bearing : joint_.team.bearings) add(bearing.i, bearing.j.pose);
    return links;
  }

 private:
  std::vector<std::size_t> radio_ranges() const {
    return factors_of(joint_.origins.ranges, FactorSource::kRange);
  }

  /// The direct angle between two robots that is closest in time to a range between them.
  const BearingFactor<Pose>* nearest_bearing(PoseId receiver, PoseId transmitter, Stamp stamp) const {
    const BearingFactor<Pose>* best = nullptr;
    double best_s = pairing_s_;
    for (const auto& bearing : joint_.team.bearings) {
      if (!bearing.j.pose.valid() || origins_.of(bearing.i).robot != origins_.of(receiver).robot ||
          origins_.of(bearing.j.pose).robot != origins_.of(transmitter).robot)
        continue;
      const Stamp heard{origins_.of(bearing.i).stamp.ns + bearing.after_ns};
      const double apart_s = std::abs(seconds_between(heard, stamp));
      if (apart_s > best_s) continue;
      const auto* path = direct_path(joint_.team.graph, bearing);
      if (path) best = path, best_s = apart_s;
    }
    return best;
  }

  /// Where a direction was measured and what it pointed at, in the frames of the range's poses.
  struct Sight {
    Pose T_pose_receiver;
    typename Pose::Point transmitter;
    double azimuth_rad;  ///< in the receiver's frame
  };

  Sight sight(const BearingFactor<Pose>& bearing, PoseId of_receiver, PoseId of_transmitter) const {
    const auto& poses = joint_.team.graph.poses;
    const auto moved = [&](PoseId from, PoseId to) {
      return poses[from.index()].inverse() * poses[to.index()];
    };
    return {moved(of_receiver, bearing.i) * bearing.T_i_receiver,
            moved(of_transmitter, bearing.j.pose) * bearing.j.lever_arm,
            std::atan2(bearing.direction.y(), bearing.direction.x())};
  }

  /// The azimuth of antenna b at antenna a, at the time of the range: robots move in between.
  static double azimuth_then(const Sight& seen, const Pose& T_i_j, const RangeEnd<Pose>& a,
                             const RangeEnd<Pose>& b) requires(Pose::kDim == 2) {
    const Eigen::Vector2d then = T_i_j * b.lever_arm - a.lever_arm,
                          measured = seen.T_pose_receiver.inverse() * (T_i_j * seen.transmitter);
    return seen.azimuth_rad + std::atan2(then.y(), then.x()) - std::atan2(measured.y(), measured.x());
  }

  OverlapLink<Pose> link(const RangeFactor<Pose>& range, const BearingFactor<Pose>& by_i,
                         const BearingFactor<Pose>& by_j) const requires(Pose::kDim == 2) {
    const Sight i = sight(by_i, range.i.pose, range.j.pose), j = sight(by_j, range.j.pose, range.i.pose);
    const UncertainPose<Pose> T_i_a{Pose(range.i.lever_arm, 0)}, T_j_b{Pose(range.j.lever_arm, 0)};
    MutualBearing measured{range.range_m,
                           range.sigma_m,
                           i.azimuth_rad + heading(i.T_pose_receiver),
                           by_i.sigma_rad,
                           j.azimuth_rad + heading(j.T_pose_receiver),
                           by_j.sigma_rad};
    for (int k = 0; k < kMotionRounds; ++k) {
      const Pose T_i_j = T_i_a.pose * relative_pose(measured) * T_j_b.pose.inverse();
      measured.phi_rad = azimuth_then(i, T_i_j, range.i, range.j);
      measured.psi_rad = azimuth_then(j, T_i_j.inverse(), range.j, range.i);
    }
    const UncertainPose<Pose> T_a_b{relative_pose(measured), relative_pose_covariance(measured)};
    const UncertainPose<Pose> T_i_j = T_i_a * T_a_b * T_j_b.inverse();
    return at_keyframes(range.i.pose, range.j.pose, T_i_j.pose, T_i_j.covariance);
  }

  /// Moved along the odometry to the keyframes before these poses.
  OverlapLink<Pose> at_keyframes(PoseId i, PoseId j, const Pose& T_i_j,
                                 const typename Pose::Jacobian& covariance) const {
    const PoseOrigin &a = origins_.of(i), &b = origins_.of(j);
    const auto& poses = joint_.team.graph.poses;
    const Pose T_ka_i = poses[joint_.robots[a.robot].poses[a.keyframe].index()].inverse() * poses[i.index()];
    const Pose T_j_kb = poses[j.index()].inverse() * poses[joint_.robots[b.robot].poses[b.keyframe].index()];
    const typename Pose::Jacobian carry = T_j_kb.inverse().adjoint();
    OverlapLink<Pose> link{a.robot,
                           a.keyframe,
                           b.robot,
                           b.keyframe,
                           T_ka_i * T_i_j * T_j_kb,
                           carry * covariance * carry.transpose()};
    return a.robot < b.robot ? link : reversed(link);
  }

  static OverlapLink<Pose> reversed(const OverlapLink<Pose>& link) {
    const typename Pose::Jacobian turn = link.T_a_b.adjoint();
    return {link.robot_b, link.pose_b,          link.robot_a,
            link.pose_a,  link.T_a_b.inverse(), congruence(turn, link.covariance)};
  }

  const JointGraph<Pose>& joint_;
  const PoseOrigins<Pose>& origins_;
  double pairing_s_;
};

/// At most `most` links per pair of robots, evenly spaced.
template <class Pose>
std::vector<OverlapLink<Pose>> thinned(const std::vector<OverlapLink<Pose>>& links, std::size_t most) {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> total, seen;
  for (const auto& link : links) ++total[{link.robot_a, link.robot_b}];
  std::vector<OverlapLink<Pose>> kept;
  for (const auto& link : links) {
    const std::size_t n = total[{link.robot_a, link.robot_b}], k = seen[{link.robot_a, link.robot_b}]++;
    if (n <= most || (k + 1) * most / n != k * most / n) kept.push_back(link);
  }
  return kept;
}

}  // namespace

SE2 relative_pose(const MutualBearing& m) {
  return {m.range_m * Eigen::Vector2d(std::cos(m.phi_rad), std::sin(m.phi_rad)),
          m.phi_rad + std::numbers::pi - m.psi_rad};
}

SE2::Jacobian relative_pose_covariance(const MutualBearing& m) {
  const double c = std::cos(m.psi_rad), s = std::sin(m.psi_rad), d = m.range_m;
  SE2::Jacobian j;  // columns: range, phi, psi
  j << -c, d * s, 0, -s, -d * c, 0, 0, 1, -1;
  const double phi2 = m.sigma_phi_rad * m.sigma_phi_rad;
  const Eigen::Vector3d variance(m.sigma_range_m * m.sigma_range_m + d * d * phi2 * phi2 / 2, phi2,
                                 m.sigma_psi_rad * m.sigma_psi_rad);
  return j * variance.asDiagonal() * j.transpose();
}

template <class Pose>
MeasuredLinks<Pose> measured_links(const JointGraph<Pose>& joint, double pairing_s, std::size_t max_links) {
  const PoseOrigins<Pose> origins(joint);
  const MutualBearings<Pose> measured(joint, origins, pairing_s);
  auto links = measured.from_mutual_bearings();
  const bool estimated = links.empty();
  if (estimated) links = measured.estimated();
  return {{odometry_chains(joint, origins), thinned(links, max_links)}, estimated};
}

template MeasuredLinks<SE2> measured_links(const JointGraph<SE2>&, double, std::size_t);
template MeasuredLinks<SE3> measured_links(const JointGraph<SE3>&, double, std::size_t);

}  // namespace radioslam
