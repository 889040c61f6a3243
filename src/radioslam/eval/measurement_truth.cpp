#include "radioslam/eval/measurement_truth.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <tuple>

#include "radioslam/base/check.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/eval/association.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {
namespace {

// Whether the likeliest path of an angle measurement is the direct one.
//
// By the simulator's label where there is one, else by geometry: a path is direct if it is within 3 sigma + 5
// degrees of the true direction of the transmitter; by azimuth only if it has no elevation.

enum class AngleTruth {
  kDirectFound,  ///< the likeliest path is direct
  kWrongPath,    ///< another one is
  kNoneDirect,   ///< none is
};

constexpr double kSigmas = 3;
constexpr double kSlack_m = 0.5;
constexpr double kSlack_rad = 5 * kRadiansPerDegree;

bool points_to(const AoaPath& path, const Eigen::Vector3d& direction) {
  const double horizontal = std::hypot(direction.x(), direction.y());
  const double azimuth_error =
      std::remainder(std::atan2(direction.y(), direction.x()) - path.azimuth_rad, 2 * std::numbers::pi);
  const double elevation_error =
      path.elevation_rad ? std::atan2(direction.z(), horizontal) - *path.elevation_rad : 0;
  return std::hypot(azimuth_error, elevation_error) <= kSigmas * path.sigma_rad + kSlack_rad;
}

/// Index of the greatest weight, the first of equal ones. Nothing unless every path has a weight; a single
/// path needs none.
std::optional<std::size_t> likeliest_path(const std::vector<double>& weights, std::size_t paths) {
  if (paths == 1) return 0;
  if (weights.size() != paths || paths == 0) return std::nullopt;
  return static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

/// `direct_path`: the label, as in Truth::direct_paths.
AngleTruth compare_path(std::size_t path, int direct_path) {
  if (direct_path == kNoDirectPath) return AngleTruth::kNoneDirect;
  return static_cast<int>(path) == direct_path ? AngleTruth::kDirectFound : AngleTruth::kWrongPath;
}

/// `direction`: of the transmitter, in the receiver's body frame; of any length.
AngleTruth compare_path(std::size_t path, const std::vector<AoaPath>& paths,
                        const Eigen::Vector3d& direction) {
  if (points_to(paths[path], direction)) return AngleTruth::kDirectFound;
  const bool other_is_direct =
      std::any_of(paths.begin(), paths.end(), [&](const AoaPath& p) { return points_to(p, direction); });
  return other_is_direct ? AngleTruth::kWrongPath : AngleTruth::kNoneDirect;
}

/// An angle measurement with its label, as in Truth::direct_paths.
struct LabelledAngle {
  AoaMeasurement measured;
  std::optional<int> direct_path;
};

/// Standard deviation along the direction of an error.
double sigma_along(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d direction = error.stableNormalized();
  return std::sqrt(direction.dot(covariance * direction));
}

/// A relative pose against the truth. Nothing where neither label nor truth is known.
struct ComparedPose {
  std::optional<bool> is_true;
  std::optional<double> error_m, error_rad;
};

RobotIndex robot_of(const Mission& mission, const std::string& id) {
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    if (mission.robots[r].id == id) return RobotIndex(r);
  RADIOSLAM_CHECK(false, "measured angles are between robots of the mission");
}

/// An angle from CSI; packets are sent by a card's first antenna.
AoaMeasurement measurement_of(const MeasuredAoaResult& measured, const Mission& mission) {
  const RobotIndex transmitter = robot_of(mission, measured.transmitter);
  LinkEnd end;
  end.robot = transmitter;
  const auto& csi = mission.robots[transmitter.index()].csi;
  if (csi && !csi->antennas_m.empty()) end.lever_arm_m = csi->antennas_m.front();
  return {measured.stamp, robot_of(mission, measured.receiver), end, measured.paths};
}

/// The angles of a run in its order: by time, those of the mission before those from CSI.
std::vector<LabelledAngle> angles_of_run(const Mission& mission, const Truth& truth,
                                         const std::vector<MeasuredAoaResult>& measured_aoa) {
  std::vector<LabelledAngle> angles;
  for (std::size_t k = 0; k < mission.aoa_measurements.size(); ++k)
    angles.push_back(
        {mission.aoa_measurements[k], k < truth.direct_paths.size() ? truth.direct_paths[k] : std::nullopt});
  for (const auto& measured : measured_aoa) angles.push_back({measurement_of(measured, mission), {}});
  std::stable_sort(angles.begin(), angles.end(),
                   [](const auto& a, const auto& b) { return a.measured.stamp < b.measured.stamp; });
  return angles;
}

class TruthComparison {
 public:
  TruthComparison(const Mission& mission, const Truth& truth) : mission_(mission), truth_(truth) {}

  ComparedPose relative_pose(const PoseMatch& measured, std::optional<bool> label) const {
    const auto i = pose(measured.robot_i, measured.stamp_i), j = pose(measured.robot_j, measured.stamp_j);
    if (!i || !j) return {label, std::nullopt, std::nullopt};
    SE3 error = measured.T_i_j.inverse() * i->inverse() * *j;
    if (mission_.dimension == 2) error = lift(flatten(error));
    const Eigen::Vector3d shift_m = error.translation(), turn_rad = so3_log(error.rotation());
    const double sigma_m = sigma_along(shift_m, measured.covariance.topLeftCorner<3, 3>()),
                 sigma_rad = sigma_along(turn_rad, measured.covariance.bottomRightCorner<3, 3>());
    const bool agrees =
        shift_m.norm() <= kSigmas * sigma_m + kSlack_m && turn_rad.norm() <= kSigmas * sigma_rad + kSlack_rad;
    return {label.value_or(agrees), shift_m.norm(), turn_rad.norm()};
  }

  ComparedPose match(std::size_t k) const {
    return relative_pose(mission_.matches[k],
                         k < truth_.true_matches.size() ? truth_.true_matches[k] : std::nullopt);
  }

  /// Whether the measurement is true; nothing where the truth does not cover it.
  std::optional<bool> range(std::size_t k) const {
    const RangeMeasurement& measured = mission_.ranges[k];
    auto i = position_m(measured.i, measured.stamp), j = position_m(measured.j, measured.stamp);
    if (!i || !j) return std::nullopt;
    if (mission_.dimension == 2) i->z() = j->z();
    return std::abs((*i - *j).norm() - measured.range_m) <= kSigmas * measured.sigma_m + kSlack_m;
  }

  std::optional<AngleTruth> angle(const LabelledAngle& angle, const std::vector<double>& weights) const {
    const AoaMeasurement& measured = angle.measured;
    const auto path = likeliest_path(weights, measured.paths.size());
    if (!path) return std::nullopt;
    if (angle.direct_path) return compare_path(*path, *angle.direct_path);
    const auto receiver = pose(measured.receiver, measured.stamp);
    const auto transmitter = position_m(measured.transmitter, measured.stamp);
    if (!receiver || !transmitter) return std::nullopt;
    return compare_path(*path, measured.paths, receiver->inverse() * *transmitter);
  }

 private:
  std::optional<SE3> pose(RobotIndex robot, Stamp stamp) const {
    const RobotTruth& of = truth_.robots[robot.index()];
    return of.has_orientation ? pose_at(of.poses, stamp) : std::nullopt;
  }

  std::optional<Eigen::Vector3d> position_m(const LinkEnd& end, Stamp stamp) const {
    std::optional<Eigen::Vector3d> position;
    if (end.robot.valid()) {
      // Where only positions are known, those of antennas are not, unless they are at the body's origin.
      const RobotTruth& of = truth_.robots[end.robot.index()];
      if (of.has_orientation || end.lever_arm_m.isZero(0))
        if (const auto at = pose_at(of.poses, stamp)) position = *at * end.lever_arm_m;
    } else {
      position = mission_.anchors[end.anchor.index()].position_m;
    }
    return position;
  }

  const Mission& mission_;
  const Truth& truth_;
};

using Ends = std::tuple<RobotIndex, Stamp, RobotIndex, Stamp>;

/// The ends of a link; none where the odometry does not cover both, as the run ignored such links.
Ends link_ends(RobotIndex i, RobotIndex j, Stamp stamp, const std::vector<std::vector<Stamp>>& keyframes) {
  const auto covers = [&](RobotIndex robot) {
    if (!robot.valid() || keyframes[robot.index()].empty()) return false;
    return keyframes[robot.index()].front() <= stamp && stamp <= keyframes[robot.index()].back();
  };
  if (!covers(i) || !covers(j)) return {};
  return {i, stamp, j, stamp};
}

/// Loops of a factor graph, all of whose poses are keyframes, also those that are not placed.
std::vector<std::vector<Stamp>> stamps_of_loops(const std::vector<PoseMatch>& loops, std::size_t robots) {
  std::vector<std::vector<Stamp>> stamps(robots);
  for (const PoseMatch& loop : loops) {
    stamps[loop.robot_i.index()].push_back(loop.stamp_i);
    stamps[loop.robot_j.index()].push_back(loop.stamp_j);
  }
  for (std::vector<Stamp>& of_robot : stamps) std::sort(of_robot.begin(), of_robot.end());
  return stamps;
}

/// Measurements of one kind by robots and keyframes, each given out once, in their order.
class MeasurementsByKeyframes {
 public:
  template <class EndsOf>
  MeasurementsByKeyframes(std::size_t count, const EndsOf& ends_of,
                          const std::vector<std::vector<Stamp>>& keyframes) {
    for (std::size_t k = 0; k < count; ++k) {
      const auto [i, stamp_i, j, stamp_j] = ends_of(k);
      if (!i.valid() || !j.valid()) continue;
      const auto &of_i = keyframes[i.index()], &of_j = keyframes[j.index()];
      if (of_i.empty() || of_j.empty()) continue;
      by_keyframes_[{i, of_i[keyframe_before(of_i, stamp_i)], j, of_j[keyframe_before(of_j, stamp_j)]}]
          .push_back(k);
    }
  }

  std::optional<std::size_t> take(const ClosureResult& closure) {
    const auto found =
        by_keyframes_.find({closure.robot_i, closure.stamp_i, closure.robot_j, closure.stamp_j});
    if (found == by_keyframes_.end() || found->second.empty()) return std::nullopt;
    const std::size_t k = found->second.front();
    found->second.pop_front();
    return k;
  }

 private:
  std::map<Ends, std::deque<std::size_t>> by_keyframes_;
};

void count(ComparedClosures& counts, ClosureStatus status, bool is_true) {
  if (status == ClosureStatus::kAccepted) {
    ++counts.accepted;
    counts.true_accepted += is_true ? 1U : 0U;
  } else {
    ++counts.rejected;
    counts.true_rejected += is_true ? 1U : 0U;
  }
}

void count(ComparedClosures& counts, ClosureStatus status, AngleTruth angle) {
  count(counts, status, angle == AngleTruth::kDirectFound);
  if (status != ClosureStatus::kAccepted) return;
  counts.direct_found += angle == AngleTruth::kDirectFound ? 1U : 0U;
  counts.wrong_path += angle == AngleTruth::kWrongPath ? 1U : 0U;
  counts.none_direct += angle == AngleTruth::kNoneDirect ? 1U : 0U;
}

void count(ComparedClosures& counts, ClosureStatus status, const ComparedPose& compared) {
  count(counts, status, *compared.is_true);
  if (!compared.error_m || status != ClosureStatus::kAccepted) return;
  counts.worst_accepted_m = std::max(counts.worst_accepted_m.value_or(0), *compared.error_m);
  counts.worst_accepted_rad = std::max(counts.worst_accepted_rad.value_or(0), *compared.error_rad);
}

MeasurementsByKeyframes matches_by_keyframes(const std::vector<PoseMatch>& matches,
                                             const std::vector<std::vector<Stamp>>& keyframes) {
  const auto ends = [&](std::size_t k) {
    const PoseMatch& m = matches[k];
    return Ends{m.robot_i, m.stamp_i, m.robot_j, m.stamp_j};
  };
  return {matches.size(), ends, keyframes};
}

MeasurementsByKeyframes ranges_by_keyframes(const Mission& mission,
                                            const std::vector<std::vector<Stamp>>& keyframes) {
  const auto ends = [&](std::size_t k) {
    const RangeMeasurement& m = mission.ranges[k];
    return link_ends(m.i.robot, m.j.robot, m.stamp, keyframes);
  };
  return {mission.ranges.size(), ends, keyframes};
}

MeasurementsByKeyframes angles_by_keyframes(const std::vector<LabelledAngle>& angles,
                                            const std::vector<std::vector<Stamp>>& keyframes) {
  const auto ends = [&](std::size_t k) {
    const AoaMeasurement& m = angles[k].measured;
    return link_ends(m.receiver, m.transmitter.robot, m.stamp, keyframes);
  };
  return {angles.size(), ends, keyframes};
}

}  // namespace

ClosuresByKind compare_closures_with_truth(const std::vector<ClosureResult>& closures,
                                           const std::vector<std::vector<Stamp>>& keyframes,
                                           const Mission& mission, const Truth& truth,
                                           const std::vector<MeasuredAoaResult>& measured_aoa,
                                           const FileLoops& file) {
  const TruthComparison comparison(mission, truth);
  const std::vector<LabelledAngle> angles = angles_of_run(mission, truth, measured_aoa);
  auto matches = matches_by_keyframes(mission.matches, keyframes),
       loops = matches_by_keyframes(file.loops, stamps_of_loops(file.loops, keyframes.size())),
       ranges = ranges_by_keyframes(mission, keyframes),
       aoa_measurements = angles_by_keyframes(angles, keyframes);
  ClosuresByKind counts;
  const auto count_if_covered = [&](const ClosureResult& closure, const auto& is_true) {
    if (is_true) count(counts[closure.kind], closure.status, *is_true);
  };
  const auto count_pose = [&](const ClosureResult& closure, const ComparedPose& compared) {
    if (compared.is_true) count(counts[closure.kind], closure.status, compared);
  };
  for (const ClosureResult& closure : closures) {
    if (closure.kind == ClosureKind::kMatch) {
      if (const auto k = matches.take(closure)) count_pose(closure, comparison.match(*k));
    } else if (closure.kind == ClosureKind::kFile) {
      if (const auto k = loops.take(closure))
        count_pose(closure, comparison.relative_pose(
                                file.loops[*k], *k < file.labels.size() ? file.labels[*k] : std::nullopt));
    } else if (closure.kind == ClosureKind::kLidar) {
      if (closure.T_i_j && closure.robot_i != closure.robot_j)
        count_pose(closure, comparison.relative_pose({closure.robot_i, closure.robot_j, closure.stamp_i,
                                                      closure.stamp_j, *closure.T_i_j, SE3::Jacobian::Zero()},
                                                     std::nullopt));
    } else if (closure.kind == ClosureKind::kRange) {
      if (const auto k = ranges.take(closure)) count_if_covered(closure, comparison.range(*k));
    } else if (closure.kind == ClosureKind::kAoa) {
      if (const auto k = aoa_measurements.take(closure))
        count_if_covered(closure, comparison.angle(angles[*k], closure.path_weights));
    }
  }
  return counts;
}

}  // namespace radioslam
