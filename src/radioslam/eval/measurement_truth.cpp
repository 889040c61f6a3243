#include "radioslam/eval/measurement_truth.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <tuple>

#include "radioslam/base/units.hpp"
#include "radioslam/eval/association.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/mission/keyframes.hpp"

namespace radioslam {
namespace {

constexpr double kSigmas = 3;
constexpr double kSlack_m = 0.5;
constexpr double kSlack_rad = 5 * kRadiansPerDegree;

class MeasurementJudge {
 public:
  MeasurementJudge(const Mission& mission, const Truth& truth) : mission_(mission), truth_(truth) {}

  /// Whether the measurement is true; nothing where the truth does not cover it.
  std::optional<bool> match(std::size_t k) const {
    if (k < truth_.true_matches.size() && truth_.true_matches[k]) return truth_.true_matches[k];
    const PoseMatch& measured = mission_.matches[k];
    const auto i = pose(measured.robot_i, measured.stamp_i), j = pose(measured.robot_j, measured.stamp_j);
    if (!i || !j) return std::nullopt;
    SE3 error = measured.T_i_j.inverse() * i->inverse() * *j;
    if (mission_.dimension == 2) error = lift(flatten(error));
    return error.translation().norm() <= kSigmas * measured.sigma_t_m + kSlack_m &&
           so3_log(error.rotation()).norm() <= kSigmas * measured.sigma_r_rad + kSlack_rad;
  }

  std::optional<bool> range(std::size_t k) const {
    const RangeMeasurement& measured = mission_.ranges[k];
    auto i = position_m(measured.i, measured.stamp), j = position_m(measured.j, measured.stamp);
    if (!i || !j) return std::nullopt;
    if (mission_.dimension == 2) i->z() = j->z();
    return std::abs((*i - *j).norm() - measured.range_m) <= kSigmas * measured.sigma_m + kSlack_m;
  }

  std::optional<bool> aoa(std::size_t k) const {
    const AoaMeasurement& measured = mission_.aoa_measurements[k];
    if (k < truth_.direct_paths.size() && truth_.direct_paths[k] == kNoDirectPath) return false;
    const auto receiver = pose(measured.receiver, measured.stamp);
    const auto transmitter = position_m(measured.transmitter, measured.stamp);
    if (!receiver || !transmitter) return std::nullopt;
    const Eigen::Vector3d direction = receiver->inverse() * *transmitter;
    return std::any_of(measured.paths.begin(), measured.paths.end(),
                       [&](const AoaPath& path) { return points_to(path, direction); });
  }

 private:
  std::optional<SE3> pose(RobotIndex robot, Stamp stamp) const {
    const RobotTruth& of = truth_.robots[robot.index()];
    return of.has_orientation ? pose_at(of.poses, stamp) : std::nullopt;
  }

  std::optional<Eigen::Vector3d> position_m(const LinkEnd& end, Stamp stamp) const {
    std::optional<Eigen::Vector3d> position;
    if (end.robot.valid()) {
      if (const auto at = pose(end.robot, stamp)) position = *at * end.lever_arm_m;
    } else {
      position = mission_.anchors[end.anchor.index()].position_m;
    }
    return position;
  }

  static bool points_to(const AoaPath& path, const Eigen::Vector3d& direction) {
    const double horizontal = std::hypot(direction.x(), direction.y());
    const double azimuth_error =
        std::remainder(std::atan2(direction.y(), direction.x()) - path.azimuth_rad, 2 * std::numbers::pi);
    const double elevation_error =
        path.elevation_rad ? std::atan2(direction.z(), horizontal) - *path.elevation_rad : 0;
    return std::hypot(azimuth_error, elevation_error) <= kSigmas * path.sigma_rad + kSlack_rad;
  }

  const Mission& mission_;
  const Truth& truth_;
};

using Ends = std::tuple<RobotIndex, Stamp, RobotIndex, Stamp>;

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

void count(JudgedClosures& counts, ClosureStatus status, bool is_true) {
  if (status == ClosureStatus::kAccepted) {
    ++counts.accepted;
    counts.true_accepted += is_true ? 1U : 0U;
  } else {
    ++counts.rejected;
    counts.true_rejected += is_true ? 1U : 0U;
  }
}

}  // namespace

std::map<ClosureKind, JudgedClosures> judge_closures(const std::vector<ClosureResult>& closures,
                                                     const std::vector<std::vector<Stamp>>& keyframes,
                                                     const Mission& mission, const Truth& truth) {
  const MeasurementJudge judge(mission, truth);
  MeasurementsByKeyframes matches(
      mission.matches.size(),
      [&](std::size_t k) {
        const PoseMatch& m = mission.matches[k];
        return Ends{m.robot_i, m.stamp_i, m.robot_j, m.stamp_j};
      },
      keyframes);
  MeasurementsByKeyframes ranges(
      mission.ranges.size(),
      [&](std::size_t k) {
        const RangeMeasurement& m = mission.ranges[k];
        return Ends{m.i.robot, m.stamp, m.j.robot, m.stamp};
      },
      keyframes);
  MeasurementsByKeyframes angles(
      mission.aoa_measurements.size(),
      [&](std::size_t k) {
        const AoaMeasurement& m = mission.aoa_measurements[k];
        return Ends{m.receiver, m.stamp, m.transmitter.robot, m.stamp};
      },
      keyframes);
  std::map<ClosureKind, JudgedClosures> counts;
  for (const ClosureResult& closure : closures) {
    std::optional<bool> is_true;
    if (closure.kind == ClosureKind::kMatch) {
      if (const auto k = matches.take(closure)) is_true = judge.match(*k);
    } else if (closure.kind == ClosureKind::kRange) {
      if (const auto k = ranges.take(closure)) is_true = judge.range(*k);
    } else if (closure.kind == ClosureKind::kAoa) {
      if (const auto k = angles.take(closure)) is_true = judge.aoa(*k);
    }
    if (is_true) count(counts[closure.kind], closure.status, *is_true);
  }
  return counts;
}

}  // namespace radioslam
