#include "radioslam/eval/closures.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

#include "radioslam/base/check.hpp"
#include "radioslam/eval/association.hpp"

namespace radioslam {
namespace {

/// True place of a keyframe.
struct Place {
  Eigen::Vector3d position_m;
  double heading_rad = 0;
};
using Places = std::vector<Place>;

std::optional<Place> true_place(const PairTruth& truth, std::size_t robot, Stamp stamp) {
  const RobotTruth& poses = truth.truth.robots[robot];
  const double slack_s = poses.has_orientation ? 0 : kWaypointStampSlack_s;
  const auto pose = pose_near(poses.poses, stamp, slack_s);
  if (!pose) return std::nullopt;
  Place place{pose->translation(), pose->yaw()};
  if (truth.dimension == 2) place.position_m.z() = 0;
  return place;
}

/// True places at the keyframes of one robot that the truth covers, ordered by x.
Places true_places(const PairTruth& truth, std::size_t robot, const KeyframeStamps& keyframes) {
  Places places;
  for (const Stamp stamp : keyframes)
    if (const auto place = true_place(truth, robot, stamp)) places.push_back(*place);
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return a.position_m.x() < b.position_m.x(); });
  return places;
}

/// Which keyframes of two robots are true pairs.
struct PairRule {
  OverlapSensor a, b;
  double min_shared_view = 0;
  double radius_m = 0;  ///< true pairs are closer

  bool is_true(const Place& of_a, const Place& of_b) const {
    if (!((of_b.position_m - of_a.position_m).norm() < radius_m)) return false;
    const bool all_round = std::min(a.view_rad, b.view_rad) >= 2 * std::numbers::pi;
    if (min_shared_view <= 0 || all_round) return true;
    return shared_view(view(a, of_a), view(b, of_b)) >= min_shared_view;
  }

 private:
  static ViewSector view(const OverlapSensor& sensor, const Place& from) {
    return {from.position_m.head<2>(), from.heading_rad, sensor.view_rad / 2, sensor.range_m};
  }
};

/// The rule of every two robots, by the lower and the higher index.
class PairRules {
 public:
  explicit PairRules(const PairTruth& truth) : truth_(truth), robots_(truth.views.size()) {
    RADIOSLAM_CHECK(robots_ == truth.truth.robots.size(), "every robot has one view");
    for (std::size_t i = 0; i < robots_; ++i)
      for (std::size_t j = 0; j < robots_; ++j) rules_.push_back(rule_of(view(i), view(j)));
  }

  const PairRule& between(std::size_t i, std::size_t j) const { return rules_[i * robots_ + j]; }

  /// Whether the pair is true; nothing if the truth does not cover it.
  template <class Pair>
  std::optional<bool> is_true(const Pair& pair) const {
    const auto i = pair.robot_i.index(), j = pair.robot_j.index();
    const auto of_i = true_place(truth_, i, pair.stamp_i);
    const auto of_j = true_place(truth_, j, pair.stamp_j);
    if (!of_i || !of_j) return std::nullopt;
    return i < j ? between(i, j).is_true(*of_i, *of_j) : between(j, i).is_true(*of_j, *of_i);
  }

 private:
  OverlapSensor view(std::size_t robot) const {
    if (truth_.truth.robots[robot].has_orientation) return truth_.views[robot];
    return {truth_.views[robot].range_m};
  }

  PairRule rule_of(const OverlapSensor& a, const OverlapSensor& b) const {
    const auto radius_m = max_distance_of_shared_view(a, b, truth_.min_shared_view);
    return {a, b, truth_.min_shared_view, radius_m.value_or(0)};
  }

  const PairTruth& truth_;
  std::size_t robots_;
  std::vector<PairRule> rules_;
};

/// Number of true pairs; of `b` only the slab of x within reach is visited.
std::size_t count_true(const Places& a, const Places& b, const PairRule& rule) {
  const auto x = [](const Place& place) { return place.position_m.x(); };
  std::size_t count = 0;
  std::size_t slab = 0;
  for (const Place& p : a) {
    while (slab < b.size() && x(b[slab]) <= x(p) - rule.radius_m) ++slab;
    for (std::size_t k = slab; k < b.size() && x(b[k]) < x(p) + rule.radius_m; ++k)
      if (rule.is_true(p, b[k])) ++count;
  }
  return count;
}

}  // namespace

std::vector<OverlapSensor> lidar_views(const Mission& mission) {
  std::vector<OverlapSensor> views;
  for (const Robot& robot : mission.robots) views.push_back({robot.lidar_range_m, robot.lidar_view_rad});
  return views;
}

std::vector<OverlapSensor> reach_for_radius(std::size_t robots, double radius_m) {
  return std::vector<OverlapSensor>(robots, {radius_m / 2});
}

PairTruth pair_truth(const Mission& mission, const Truth& truth, std::optional<double> radius_m,
                     double min_shared_view) {
  if (radius_m) return {truth, mission.dimension, reach_for_radius(mission.robots.size(), *radius_m)};
  return {truth, mission.dimension, lidar_views(mission), min_shared_view};
}

PairCounts count_candidates(const std::vector<KeyframeStamps>& keyframes, const CandidateList& candidates,
                            const PairTruth& truth) {
  const PairRules rules(truth);
  RADIOSLAM_CHECK(keyframes.size() == truth.views.size(), "every robot has keyframes and one truth");
  std::vector<Places> team;
  for (std::size_t robot = 0; robot < keyframes.size(); ++robot)
    team.push_back(true_places(truth, robot, keyframes[robot]));

  PairCounts counts;
  for (std::size_t i = 0; i < team.size(); ++i)
    for (std::size_t j = i + 1; j < team.size(); ++j) {
      counts.pairs += team[i].size() * team[j].size();
      counts.true_pairs += count_true(team[i], team[j], rules.between(i, j));
    }
  for (const auto& candidate : candidates)
    if (const auto is_true = rules.is_true(candidate)) {
      ++counts.kept;
      counts.true_kept += *is_true ? 1U : 0U;
    }
  return counts;
}

PairCounts count_closures(const std::vector<ClosureResult>& closures, const PairTruth& truth) {
  const PairRules rules(truth);
  PairCounts counts;
  for (const auto& closure : closures) {
    if (closure.robot_i == closure.robot_j) continue;
    const auto is_true = rules.is_true(closure);
    if (!is_true) continue;
    const bool kept = closure.status == ClosureStatus::kAccepted;
    ++counts.pairs;
    counts.true_pairs += *is_true ? 1U : 0U;
    counts.kept += kept ? 1U : 0U;
    counts.true_kept += *is_true && kept ? 1U : 0U;
  }
  return counts;
}

}  // namespace radioslam
