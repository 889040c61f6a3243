#include "radioslam/doctor/starts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "radioslam/base/units.hpp"
#include "radioslam/doctor/text.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

Finding finding_on(std::string robot, std::string found, std::string advice) {
  return {"start",          Severity::kWarning,          std::move(robot), "mission.yaml",
          std::move(found), "the start that they allow", std::move(advice)};
}

/// The error that the pair would have if its starts were stated in place of each other: where its relative
/// pose is found to be the inverse of the stated one.
StartError error_of_exchange(const Mission& mission, const PairOfStarts& pair) {
  const SE3 stated = mission.robots[pair.i].initial_pose->inverse() * *mission.robots[pair.j].initial_pose;
  return {(stated * stated).inverse(), pair.error->sigma_m, pair.error->sigma_rad};
}

const PairOfStarts* exchanged_pair(const Mission& mission, const std::vector<PairOfStarts>& pairs) {
  for (const PairOfStarts& pair : pairs) {
    if (!pair.error || pair.i >= mission.robots.size() || pair.j >= mission.robots.size()) continue;
    const StartError exchanged = error_of_exchange(mission, pair);
    if (exchanged.is_far() && exchanged.agrees_with(*pair.error)) return &pair;
  }
  return nullptr;
}

std::string error_text(const StartError& error) {
  return " by about " + number(error.distance_m()) + " m and " + number(degrees(error.turn_rad())) +
         " degrees";
}

}  // namespace

double StartError::turn_rad() const { return std::abs(error.yaw()); }

bool StartError::agrees_with(const StartError& other) const {
  const double apart_m = (error.translation() - other.error.translation()).head<2>().norm();
  return apart_m < 3 * std::hypot(sigma_m, other.sigma_m) &&
         std::abs(wrap_angle(error.yaw() - other.error.yaw())) < 3 * std::hypot(sigma_rad, other.sigma_rad);
}

std::vector<Finding> start_findings(const Mission& mission, const std::vector<PairOfStarts>& pairs,
                                    const std::string& measured) {
  if (const PairOfStarts* pair = exchanged_pair(mission, pairs))
    return {finding_on("",
                       "the initial_pose of " + mission.robots[pair->i].id + " and that of " +
                           mission.robots[pair->j].id + " contradict " + measured + error_text(*pair->error) +
                           ", as if they were exchanged",
                       "exchange the two, or state them as unknown")};
  std::map<std::size_t, int> balance;  // pairs that contradict less pairs that agree
  std::map<std::size_t, StartError> error;
  for (const PairOfStarts& pair : pairs)
    for (const std::size_t node : {pair.i, pair.j}) {
      if (node >= mission.robots.size()) continue;
      balance[node] += pair.error ? 1 : -1;
      if (pair.error) error[node] = *pair.error;
    }
  const auto worst = std::max_element(balance.begin(), balance.end(),
                                      [](const auto& x, const auto& y) { return x.second < y.second; });
  if (worst == balance.end() || worst->second <= 0) return {};
  const bool is_unique = std::count_if(balance.begin(), balance.end(),
                                       [&](const auto& other) { return other.second == worst->second; }) == 1;
  return {finding_on(
      is_unique ? mission.robots[worst->first].id : "",
      std::string(is_unique ? "initial_pose contradicts " : "one of two robots' initial_pose contradicts ") +
          measured + error_text(error[worst->first]),
      "correct initial_pose, or state it as unknown")};
}

}  // namespace radioslam
