#include "radioslam/pipeline/match_angles.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/mission/odometry_between.hpp"
#include "radioslam/pipeline/angle_predictions.hpp"

namespace radioslam {
namespace {

std::pair<RobotIndex, RobotIndex> ordered(RobotIndex a, RobotIndex b) { return std::minmax(a, b); }

template <class Pose>
UncertainPose<Pose> uncertain(const PoseMatch& match) {
  typename Pose::Tangent variance = Pose::Tangent::Constant(match.sigma_t_m * match.sigma_t_m);
  variance.template tail<Pose::kDof - Pose::kDim>().setConstant(match.sigma_r_rad * match.sigma_r_rad);
  return {pose_as<Pose>(match.T_i_j), variance.asDiagonal()};
}

/// The lower one of the two in the middle where there are two.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

MatchAngles::MatchAngles(const Mission& mission, const MatchParams& params,
                         const ArrivalLikelihoodParams& likelihood)
    : mission_(mission), params_(params), likelihood_(likelihood) {
  for (const Robot& robot : mission.robots) walked_m_.push_back(distance_walked(robot.odometry));
  for (std::size_t a = 0; a < mission.arrivals.size(); ++a) {
    const ArrivalMeasurement& arrival = mission.arrivals[a];
    if (is_between_robots(arrival, mission))
      arrivals_[ordered(arrival.receiver, arrival.transmitter.robot)].push_back(a);
  }
}

std::vector<std::size_t> MatchAngles::nearest(const PoseMatch& match) const {
  const auto between = arrivals_.find(ordered(match.robot_i, match.robot_j));
  if (between == arrivals_.end()) return {};
  const auto walked_m = [&](RobotIndex robot, Stamp stamp) {
    return distance_walked_at(mission_.robots[robot.index()].odometry, walked_m_[robot.index()], stamp);
  };
  const double at_i = walked_m(match.robot_i, match.stamp_i), at_j = walked_m(match.robot_j, match.stamp_j);
  std::vector<std::pair<double, std::size_t>> ways;
  for (const std::size_t a : between->second) {
    const Stamp stamp = mission_.arrivals[a].stamp;
    const double way_m =
        std::abs(walked_m(match.robot_i, stamp) - at_i) + std::abs(walked_m(match.robot_j, stamp) - at_j);
    if (way_m <= params_.most_carried_m) ways.emplace_back(way_m, a);
  }
  std::sort(ways.begin(), ways.end());
  std::vector<std::size_t> arrivals;
  for (const auto& [way_m, a] : ways)
    if (arrivals.size() < static_cast<std::size_t>(params_.angles)) arrivals.push_back(a);
  return arrivals;
}

template <class Pose>
std::optional<double> MatchAngles::information_scale(const PoseMatch& match) const {
  const Robot& robot_i = mission_.robots[match.robot_i.index()];
  const Robot& robot_j = mission_.robots[match.robot_j.index()];
  std::vector<double> scales;
  for (const std::size_t a : nearest(match)) {
    const ArrivalMeasurement& arrival = mission_.arrivals[a];
    const UncertainPose<Pose> T_i_j = odometry_between<Pose>(robot_i, arrival.stamp, match.stamp_i) *
                                      uncertain<Pose>(match) *
                                      odometry_between<Pose>(robot_j, match.stamp_j, arrival.stamp);
    const bool i_receives = arrival.receiver == match.robot_i;
    scales.push_back(check_angles(i_receives ? T_i_j : T_i_j.inverse(), arrival, mission_, likelihood_)
                         .information_scale());
  }
  if (scales.empty()) return std::nullopt;
  return median(std::move(scales));
}

template std::optional<double> MatchAngles::information_scale<SE2>(const PoseMatch&) const;
template std::optional<double> MatchAngles::information_scale<SE3>(const PoseMatch&) const;

}  // namespace radioslam
