#include "radioslam/mission/keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radioslam/mission/keyframe_motion.hpp"

namespace radioslam {
namespace {

constexpr double kThinning = 0.05;  // of the allowed deviation, between samples that are looked at
constexpr double kAnything = std::numeric_limits<double>::infinity();

Trajectory<SE3> with_stamps(const Trajectory<SE3>& odometry, const std::vector<Stamp>& node_stamps) {
  std::vector<StampedPose<SE3>> rows(odometry.begin(), odometry.end());
  for (const Stamp node_stamp : node_stamps) rows.push_back({node_stamp, *odometry.at(node_stamp)});
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  rows.erase(
      std::unique(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.stamp == b.stamp; }),
      rows.end());
  return Trajectory<SE3>(std::move(rows));
}

/// A time at which a robot measured something, and how well; zero: it is a keyframe in any case.
struct Occasion {
  Stamp stamp;
  double sigma_m = kAnything, sigma_rad = kAnything;
};

/// In time order.
std::vector<Occasion> occasions_of(const Mission& mission, RobotIndex robot,
                                   const std::vector<Stamp>& given) {
  std::vector<Occasion> occasions;
  for (const Stamp stamp : given) occasions.push_back({stamp, 0, 0});
  for (const RangeMeasurement& range : mission.ranges)
    if (range.i.robot == robot || range.j.robot == robot) occasions.push_back({range.stamp, range.sigma_m});
  for (const AoaMeasurement& angles : mission.aoa_measurements)
    if (angles.receiver == robot)
      for (const AoaPath& path : angles.paths) occasions.push_back({angles.stamp, kAnything, path.sigma_rad});
  for (const PositionFix& fix : mission.robots[robot.index()].fixes)
    occasions.push_back({fix.stamp, fix.sigma_m});
  for (const PoseMatch& match : mission.matches) {
    const auto variances = match.covariance.diagonal();
    const double sigma_m = std::sqrt(variances.head<3>().minCoeff()),
                 sigma_rad = std::sqrt(variances.tail<3>().minCoeff());
    if (match.robot_i == robot) occasions.push_back({match.stamp_i, sigma_m, sigma_rad});
    if (match.robot_j == robot) occasions.push_back({match.stamp_j, sigma_m, sigma_rad});
  }
  std::stable_sort(occasions.begin(), occasions.end(),
                   [](const Occasion& a, const Occasion& b) { return a.stamp < b.stamp; });
  return occasions;
}

/// The larger one of two, each relative to what is allowed.
double allowances(const SE3& off, const KeyframeParams& params) {
  const auto of = [](double by, double allowed) { return allowed > 0 ? by / allowed : 0; };
  return std::max(of(off.translation().norm(), params.max_deviation_m),
                  of(off.log().tail<3>().norm(), params.max_deviation_rad));
}

class KeyframeChoice {
 public:
  KeyframeChoice(const Robot& robot, const KeyframeParams& params)
      : robot_(robot), params_(params), motion_(robot, keyframes_) {}

  /// The next sample of the odometry.
  void add(const StampedPose<SE3>& sample) {
    if (!keyframes_.empty()) bound_deviation(sample);
    if (keyframes_.empty() || is_new_keyframe(last_.pose, sample.pose, params_)) start(sample);
    if (allowances(way_.back().pose.inverse() * sample.pose, params_) >= kThinning) {
      if (way_.back().stamp < last_sample_.stamp) extend_way(last_sample_);
      extend_way(sample);
    }
    last_sample_ = sample;
  }

  /// A time from the last sample to the next one, which shall be a keyframe.
  void add(Stamp stamp) {
    if (stamp <= last_.stamp) return;
    const StampedPose<SE3> here{stamp, *robot_.odometry.at(stamp)};
    bound_deviation(here);
    start(here);
  }

  bool is_better_than_odometry(const Occasion& occasion) {
    const SE3::Tangent variances = motion_.at(occasion.stamp).T_keyframe_body.covariance.diagonal();
    return occasion.sigma_m <= 0 || variances.head<3>().maxCoeff() > occasion.sigma_m * occasion.sigma_m ||
           variances.tail<3>().maxCoeff() > occasion.sigma_rad * occasion.sigma_rad;
  }

  std::vector<Stamp> finish() && {
    if (!keyframes_.empty()) add(last_sample_.stamp);
    return std::move(keyframes_);
  }

 private:
  void start(const StampedPose<SE3>& keyframe) {
    keyframes_.push_back(keyframe.stamp);
    last_ = keyframe;
    way_ = {keyframe};
    farthest_ = 0;
  }

  void extend_way(const StampedPose<SE3>& sample) {
    way_.push_back(sample);
    farthest_ = std::max(farthest_, allowances(last_.pose.inverse() * sample.pose, params_));
  }

  /// Makes the last sample a keyframe if the geodesic from the last one to `next` would leave the path.
  void bound_deviation(const StampedPose<SE3>& next) {
    const SE3 T_last_next = last_.pose.inverse() * next.pose;
    if (farthest_ + allowances(T_last_next, params_) <= 1) return;  // so is every point between
    const SE3::Tangent way = T_last_next.log();
    const double duration_s = seconds_between(last_.stamp, next.stamp);
    for (const StampedPose<SE3>& sample : way_) {
      const SE3 drawn = last_.pose * SE3::exp(seconds_between(last_.stamp, sample.stamp) / duration_s * way);
      if (allowances(drawn.inverse() * sample.pose, params_) > 1)
        return start(StampedPose<SE3>(last_sample_.stamp < next.stamp ? last_sample_ : sample));
    }
  }

  const Robot& robot_;
  const KeyframeParams& params_;
  std::vector<Stamp> keyframes_;
  StampedPose<SE3> last_;
  std::vector<StampedPose<SE3>> way_;  ///< from it; of samples close to each other, the first and last
  StampedPose<SE3> last_sample_;
  double farthest_ = 0;  ///< of it from the last keyframe, in allowances
  KeyframeMotion<SE3> motion_;
};

}  // namespace

bool is_new_keyframe(const SE3& last, const SE3& pose, const KeyframeParams& params) {
  const SE3 step = last.inverse() * pose;
  return step.translation().norm() >= params.distance_m || step.log().tail<3>().norm() >= params.angle_rad;
}

std::vector<Stamp> choose_keyframes(const Mission& mission, RobotIndex robot, const KeyframeParams& params,
                                    const std::vector<Stamp>& given) {
  const Trajectory<SE3>& odometry = mission.robots[robot.index()].odometry;
  const std::vector<Occasion> occasions = occasions_of(mission, robot, given);
  KeyframeChoice choice(mission.robots[robot.index()], params);
  auto occasion = occasions.begin();
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    choice.add(odometry[i]);
    if (i + 1 == odometry.size()) break;
    for (; occasion != occasions.end() && occasion->stamp < odometry[i + 1].stamp; ++occasion)
      if (odometry[i].stamp <= occasion->stamp && choice.is_better_than_odometry(*occasion))
        choice.add(occasion->stamp);
  }
  return std::move(choice).finish();
}

std::vector<Stamp> keyframes_of(const Mission& mission, RobotIndex robot, const KeyframeParams& params) {
  const std::vector<Stamp>& chosen = mission.robots[robot.index()].keyframes;
  return chosen.empty() ? choose_keyframes(mission, robot, params) : chosen;
}

RobotNodes nodes_at(const Trajectory<SE3>& odometry, std::vector<Stamp> keyframes) {
  RobotNodes nodes;
  nodes.odometry = with_stamps(odometry, keyframes);
  nodes.stamps = std::move(keyframes);
  for (std::size_t row = 0, n = 0; n < nodes.stamps.size(); ++row)
    if (nodes.odometry[row].stamp == nodes.stamps[n]) nodes.rows.push_back(row), ++n;
  return nodes;
}

std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp) {
  const auto after = std::upper_bound(keyframes.begin(), keyframes.end(), stamp);
  return after == keyframes.begin() ? 0 : static_cast<std::size_t>(after - keyframes.begin()) - 1;
}

}  // namespace radioslam
