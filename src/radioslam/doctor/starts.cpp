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

/// Two robots but `named`, of which an exchange explains every pair of robots as well: starts that are each
/// other's half turn keep their relative pose when exchanged.
const PairOfStarts* other_exchange(const Mission& mission, const std::vector<PairOfStarts>& pairs,
                                   std::size_t named) {
  const std::size_t robots = mission.robots.size();
  const auto start = [&](std::size_t node, const PairOfStarts& exchanged) {
    const std::size_t as = node == exchanged.i ? exchanged.j : node == exchanged.j ? exchanged.i : node;
    return *mission.robots[as].initial_pose;
  };
  for (const PairOfStarts& exchanged : pairs) {
    if (exchanged.error || exchanged.i >= robots || exchanged.j >= robots || exchanged.i == named ||
        exchanged.j == named)
      continue;
    const bool explains = std::all_of(pairs.begin(), pairs.end(), [&](const PairOfStarts& pair) {
      if (!pair.error || pair.i >= robots || pair.j >= robots) return true;
      const SE3 found = mission.robots[pair.i].initial_pose->inverse() *
                        *mission.robots[pair.j].initial_pose * pair.error->error;
      const SE3 stated = start(pair.i, exchanged).inverse() * start(pair.j, exchanged);
      return !StartError{stated.inverse() * found, pair.error->sigma_m, pair.error->sigma_rad}.is_far();
    });
    if (explains) return &exchanged;
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
  const PairOfStarts* exchange = is_unique ? other_exchange(mission, pairs, worst->first) : nullptr;
  return {finding_on(
      is_unique ? mission.robots[worst->first].id : "",
      std::string(is_unique ? "initial_pose contradicts " : "one of two robots' initial_pose contradicts ") +
          measured + error_text(error[worst->first]) +
          (exchange ? ", or those of " + mission.robots[exchange->i].id + " and " +
                          mission.robots[exchange->j].id + " are exchanged"
                    : ""),
      "correct initial_pose, or state it as unknown")};
}

}  // namespace radioslam
